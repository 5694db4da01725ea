"""Driving pressures that give a sensor required figures, and a schedule of them for its tasks."""

from pneutouch.workflows.driving.pressures import LeakSource, read_leak
from pneutouch.workflows.driving.tasks import DrivingSchedule, driving_record, driving_schedule

__all__ = ["DrivingSchedule", "LeakSource", "driving_record", "driving_schedule", "read_leak"]

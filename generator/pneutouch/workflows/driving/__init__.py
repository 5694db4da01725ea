"""The driving pressure that gives a sensor a figure, and a schedule of them over tasks."""

from pneutouch.workflows.driving.driving import DrivingSchedule, driving_record, driving_schedule
from pneutouch.workflows.driving.pressures import LeakSource, read_leak

__all__ = ["DrivingSchedule", "LeakSource", "driving_record", "driving_schedule", "read_leak"]

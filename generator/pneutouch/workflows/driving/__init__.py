"""The driving pressure that gives a sensor a figure, and a schedule of them over tasks."""

from pneutouch.workflows.driving.driving import DrivingSchedule, driving_schedule, schedule_document
from pneutouch.workflows.driving.pressures import LeakSource, read_leak

__all__ = ["DrivingSchedule", "LeakSource", "driving_schedule", "read_leak", "schedule_document"]

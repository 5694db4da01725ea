"""The driving pressure that gives a sensor a figure, and a schedule of them over tasks."""

from pneutouch.workflows.driving.document import schedule_document
from pneutouch.workflows.driving.leak import LeakSource, read_leak
from pneutouch.workflows.driving.run import DrivingSchedule, driving_schedule

__all__ = ["DrivingSchedule", "LeakSource", "driving_schedule", "read_leak", "schedule_document"]

"""What the task of these tests needs, besides a sensor for the position."""

TASK = {"sonar", "encoder", "control", "drive"}

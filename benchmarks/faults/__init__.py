"""Real faults: processes of a living ecology are killed, stopped and ended at random moments, by seed."""

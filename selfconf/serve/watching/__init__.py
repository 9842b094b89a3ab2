"""What the server sees of an ecology on the thread of the bus: its components, its tasks, their events and history."""

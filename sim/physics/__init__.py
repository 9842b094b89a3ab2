"""The physical world: rigid bodies in PyBullet, what a camera sees of them, and chance."""

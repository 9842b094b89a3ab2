"""The PEIS-Home in PyBullet: a world, a robot and the algorithms of the experiment, guests of selfconf."""

"""How fast signals of several sizes flow between two components, beside bare Zenoh: `python -m benchmarks.signals`."""

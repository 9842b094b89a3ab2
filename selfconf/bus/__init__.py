"""The bus: one contract, a memory bus for tests and simulated histories, and the one file that speaks Zenoh."""

"""The network as a port, `port.Bus`, with two buses behind it: Zenoh, and a simulated network in memory.

`port` says what a program may ask of a network. The room `zenoh` is the one that speaks Zenoh; `memory` simulates a
network with faults, replayed by a seed. `loop` is the event loop of a bus in real time.
"""

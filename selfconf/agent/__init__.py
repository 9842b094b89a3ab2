"""The configurator as a program around the machine: it runs effects on a bus and feeds it what the bus says."""

from selfconf.agent.agent import Agent
from selfconf.agent.order import Account, Order

__all__ = ["Account", "Agent", "Order"]

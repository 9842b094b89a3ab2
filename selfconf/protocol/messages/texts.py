"""What the texts in messages are, for those that read and show them; by the name of its type a field is read."""

from __future__ import annotations

Label = str
"""A text that names something: it stands in keys and in lines for people, so it steers nothing and ends no line."""
Remark = str
"""A text for people, of which nothing else depends: on one line, whatever was said."""
Identity = str
"""The identity of a task that sites keep: it becomes the name of a file there, and a chunk of keys."""

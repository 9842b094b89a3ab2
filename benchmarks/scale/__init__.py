"""How long `configure` takes over many advertisements, beside what else could read them, in the same run."""

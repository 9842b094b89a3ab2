"""A living ecology over HTTP: SPARQL, the W3C directory of Things, server-sent events, metrics, and a page for people.

`serve_ecology` serves one until it is ended. It needs the extra `serve` (Starlette and uvicorn).
"""

from selfconf.serve.server import serve_ecology

__all__ = ["serve_ecology"]

"""A living ecology over HTTP: SPARQL, the W3C directory of Things, server-sent events, metrics, and a page for people.

`serve_ecology` serves one until it is ended, as `ServerOptions` say; `refuse_exposure` finds servers with keys that
would show to other hosts what keys protect. It needs the extra `serve` (Starlette, uvicorn).
"""

from selfconf.serve.server import ServerOptions, refuse_exposure, serve_ecology

__all__ = ["ServerOptions", "refuse_exposure", "serve_ecology"]

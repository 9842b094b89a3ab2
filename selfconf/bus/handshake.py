"""Why a handshake of mutual TLS fails, in a sentence: Zenoh says only that it is unable to connect.

One handshake more is made by Python's own TLS, with the same certificate and authorities, and its alert is worded
(RFC 8446, section 6.2). Under TLS 1.3 the other end judges this end's certificate after the handshake, so its alert
comes with the first read.
"""

from __future__ import annotations

import contextlib
import socket
import ssl

from selfconf.bus.credentials import Credentials
from selfconf.model.setting_names import setting
from selfconf.protocol.endpoints import endpoint_host, endpoint_port

HANDSHAKE = 1.5
"""Seconds that the other end may take."""
_SAID = {
    "UNKNOWN_CA": "it does not know the authority that has issued {name}",
    "DECRYPT_ERROR": "it does not know the authority that has issued {name}",
    # The TLS of Zenoh says so of one that is not valid yet, too.
    "CERTIFICATE_EXPIRED": "by its clock, the certificate of {name} has expired or is not valid yet; "
    "renew it, or are the clocks different?",
    "CERTIFICATE_REQUIRED": "it wants a certificate, and got none",
    "BAD_CERTIFICATE": "it does not believe the certificate of {name}",
    "CERTIFICATE_UNKNOWN": "it does not believe the certificate of {name}",
    "CERTIFICATE_REVOKED": "the certificate of {name} was revoked",
    "WRONG_VERSION_NUMBER": "what listens there does not speak TLS: a site without keys?",
    "RECORD_LAYER_FAILURE": "what listens there does not speak TLS: a site without keys?",
}


def why_refused(endpoint: str, credentials: Credentials) -> str:
    """What is wrong between this end and an endpoint such as `tls/127.0.0.1:7447`; empty if nothing was found."""
    host, port = endpoint_host(endpoint), endpoint_port(endpoint)
    if port is None:
        return ""
    context = ssl.create_default_context(cafile=str(credentials.authorities))
    context.verify_flags &= ~ssl.VERIFY_X509_STRICT  # Python 3.13 is stricter than Zenoh, whose refusal is explained
    context.load_cert_chain(credentials.certificate, credentials.key)
    try:
        with (
            contextlib.closing(socket.create_connection((host, port), HANDSHAKE)) as plain,
            context.wrap_socket(plain, server_hostname=host) as link,
        ):
            link.recv(1)
    except ssl.SSLCertVerificationError as error:
        return f"{endpoint} is not believed: {_distrust(error, host)}"
    except ssl.SSLError as error:
        known = (said for alert, said in _SAID.items() if alert in (error.reason or ""))
        said = next(known, "").format(name=credentials.name)
        return f"{endpoint} refuses: {said}" if said else ""
    except (OSError, ValueError, OverflowError):
        return ""  # nothing listens, or it stays silent
    return ""


def _distrust(error: ssl.SSLCertVerificationError, host: str) -> str:
    """Why this end does not believe the other one's certificate."""
    said = error.verify_message
    if "expired" in said:
        return "its certificate has expired"
    if "not yet valid" in said:
        return "its certificate is not valid yet; is the clock of this host right?"
    if "mismatch" in said or "not valid for" in said:
        return f"its certificate is not good for {host}; issue it with `{setting('host', host)}`"
    if "issuer certificate" in said or "self-signed" in said or "self signed" in said:
        return "its certificate was issued by another authority"
    return f"of its certificate it is said: {said}"

"""Who may do what: an authority and its certificates, and the rules that follow from the holders' names.

`open_keys` opens what `--keys` names: a `KeysFolder`, which gives a program what it shows to others, or the folder of
an `Authority`, which also issues, renews and revokes certificates. A `HostAuthority` issues to the components of a
host. A `Certificate` is good for `DAYS` unless told otherwise; `Principal` is what it names, of a `PrincipalKind`, and
`rules_of` what each may do, as `AccessRules` that Zenoh keeps. `Doorkeeper` keeps the rules of the `GuardedHub` of a
site (`SiteIdentity`), from `first_rules` on; `introduce` shows a program's certificate to the sites, and
`CertificateWatch` shows it again when it is renewed, and says that it expires; `is_in_time` says whether it has.
`believe` notes which site owns a component that two sites advertise, and `believed` says which sites were noted;
`written_component` is the IRI of a component that a person has written. It needs the extra `keys`.
"""

from selfconf.access.authority import DAYS, Authority, open_keys
from selfconf.access.certificates import Certificate
from selfconf.access.disputed_components import believe, believed
from selfconf.access.doorkeeper import Doorkeeper, GuardedHub, SiteIdentity, first_rules
from selfconf.access.expiry import CertificateWatch, is_in_time
from selfconf.access.host_authority import HostAuthority
from selfconf.access.introduction import introduce
from selfconf.access.keys_folder import KeysFolder
from selfconf.access.principal import Principal, PrincipalKind, written_component
from selfconf.access.rules import AccessRules, rules_of

__all__ = [
    "DAYS",
    "AccessRules",
    "Authority",
    "Certificate",
    "CertificateWatch",
    "Doorkeeper",
    "GuardedHub",
    "HostAuthority",
    "KeysFolder",
    "Principal",
    "PrincipalKind",
    "SiteIdentity",
    "believe",
    "believed",
    "first_rules",
    "introduce",
    "is_in_time",
    "open_keys",
    "rules_of",
    "written_component",
]

"""For build servers: JUnit's XML, a test case for each file."""

from __future__ import annotations

import re
from xml.etree import ElementTree

from selfconf.model.diagnostic import Report, Severity

_NOT_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def render(report: Report) -> str:
    """A file that cannot be read is an error, one that does not conform a failure; warnings are output."""
    failed = {found.file for found in report.diagnostics if found.severity is Severity.ERROR} - report.unreadable
    totals = {
        "tests": str(len(report.files)),
        "failures": str(len(failed)),
        "errors": str(len(report.unreadable)),
    }
    suites = ElementTree.Element("testsuites", {"name": "selfconf validate", **totals})
    suite = ElementTree.SubElement(suites, "testsuite", {"name": "selfconf validate", "skipped": "0", **totals})
    for file in report.files:
        _add_case(suite, file, report)
    ElementTree.indent(suites)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + ElementTree.tostring(suites, encoding="unicode") + "\n"


def _add_case(suite: ElementTree.Element, file: str, report: Report) -> None:
    """The test case of one file."""
    case = ElementTree.SubElement(suite, "testcase", {"classname": "selfconf.validate", "name": _xml(file)})
    found = [diagnostic for diagnostic in report.diagnostics if diagnostic.file == file]
    errors = [diagnostic for diagnostic in found if diagnostic.severity is Severity.ERROR]
    if errors or file in report.unreadable:
        kind = "error" if file in report.unreadable else "failure"
        first = errors[0].message if errors else "cannot be read"
        code = errors[0].code if errors else "SC-S03"
        outcome = ElementTree.SubElement(case, kind, {"message": _xml(first), "type": code})
        outcome.text = _xml("\n".join(map(str, errors)))
    warnings = [diagnostic for diagnostic in found if diagnostic.severity is Severity.WARNING]
    if warnings:
        output = ElementTree.SubElement(case, "system-out")
        output.text = _xml("\n".join(map(str, warnings)))


def _xml(text: str) -> str:
    """Without the characters that XML cannot hold (XML 1.0, section 2.2)."""
    return _NOT_XML.sub("�", text)

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`make validate`: hold the physics against closed forms and another renderer.

Runs the cases of `validation.registry` and writes ``docs/validation.md``; a failure is told by the
exit status. ``CASES="rough-slab opal"`` runs those whose key begins so and leaves the page alone.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

from machine import machine, machine_line
from peers.mitsuba_process import variants
from validation.registry import Case, Finding, all_cases

import lamplit as ll

PAGE = Path(__file__).resolve().parent.parent / "docs" / "validation.md"


def main() -> None:
    """Run the cases that were asked for."""
    parser = argparse.ArgumentParser(description="hold Lamplit's physics against other sources")
    parser.add_argument("cases", nargs="*", help="beginnings of the cases' keys; all by default")
    options = parser.parse_args()
    if not variants():
        sys.exit("error: Mitsuba is not installed; `make validate` installs it into build/peers")
    chosen = [
        one for one in all_cases() if not options.cases or one.key.startswith(tuple(options.cases))
    ]
    if not chosen:
        sys.exit("error: no case begins so; they are " + ", ".join(c.key for c in all_cases()))
    findings: list[tuple[Case, Finding]] = []
    for one in chosen:
        start = time.perf_counter()
        own = [(one, finding) for finding in one.run()]
        findings += own
        failed = sum(not finding.holds for _, finding in own)
        verdict = "FAILS" if failed else "holds"
        print(f"{verdict} {one.key} ({time.perf_counter() - start:.0f} s)", flush=True)
        for _, finding in own:
            print(f"      {finding.quantity}: {_numbers(finding)}  {finding.note}", flush=True)
    if not options.cases:
        PAGE.write_text(as_markdown(findings), encoding="utf-8")
        print(f"written to {PAGE}")
    sys.exit(any(not finding.holds for _, finding in findings))


def as_markdown(findings: list[tuple[Case, Finding]]) -> str:
    """Return the page: a table of each group, in the order of the cases."""
    held = sum(finding.holds for _, finding in findings)
    lines = [
        "# Validation",
        "",
        "Made by `make validate`; not written by hand.",
        f"Lamplit {ll.__version__} on {machine_line(machine())}.",
        f"{held} of {len(findings)} claims hold. An estimate holds within the bar's tolerance and",
        "three standard errors, of which one (σ) is given.",
        "",
    ]
    for group in dict.fromkeys(one.group for one, _ in findings):
        lines += [
            f"## {group}",
            "",
            "| case | what | expected | got | σ | holds | source and remarks |",
            "|---|---|---|---|---|---|---|",
        ]
        for one, finding in findings:
            if one.group == group:
                sigma = f"{finding.sigma:.2g}" if finding.sigma else ""
                unit = f" {finding.unit}" if finding.unit else ""
                remarks = "; ".join(part for part in (one.source, finding.note) if part)
                lines.append(
                    f"| {one.title} | {finding.quantity} | {finding.expected:.7g}{unit} "
                    f"| {finding.got:.7g}{unit} | {sigma} | {'yes' if finding.holds else '**no**'} "
                    f"| {remarks} |"
                )
        lines.append("")
    return "\n".join(lines)


def _numbers(finding: Finding) -> str:
    return f"expected {finding.expected:.7g}, got {finding.got:.7g} ± {finding.sigma:.2g}"


if __name__ == "__main__":
    main()

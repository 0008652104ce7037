# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Whether a lamp passes: regulations as data, and verdicts with their uncertainty."""

from lamplit.rules.verdict import Finding, Outcome, Verdict

__all__ = ["Finding", "Outcome", "Verdict"]

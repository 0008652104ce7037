# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Whether a lamp passes: regulations as data, and verdicts with their uncertainty."""

from lamplit.rules.judge import judge
from lamplit.rules.judge_reflex import judge_reflex
from lamplit.rules.load import find_rule, load_rules, rule_set_names
from lamplit.rules.rule import GridNeed, ReflexAngles, Rule, RuleSet
from lamplit.rules.verdict import Finding, Outcome, Verdict

__all__ = [
    "Finding",
    "GridNeed",
    "Outcome",
    "ReflexAngles",
    "Rule",
    "RuleSet",
    "Verdict",
    "find_rule",
    "judge",
    "judge_reflex",
    "load_rules",
    "rule_set_names",
]

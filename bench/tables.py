"""Writes the tables of docs/PERFORMANCE.md from the stored figures (bench/compare --table).

Only what stands between a pair of lines <!-- NAME: from bench/results.json --> and <!-- end of NAME --> is replaced.
"""
import re

SIDES = ("128", "256", "512", "1024", "2048", "4096", "8192", "16384")


def shown(value, unit):
    if unit == "ratio":
        return f"{value:.2f} x"
    if unit != "s":
        return f"{value:,.0f} {'B' if unit == 'bytes' else unit}"
    for factor, name in ((1, "s"), (1e-3, "ms"), (1e-6, "us")):
        if value >= factor:
            return f"{value / factor:.3g} {name}"
    return f"{value / 1e-9:.3g} ns"


def plainly(value):
    """Two digits, and no more precision than there is."""
    return f"{value:.2g}" if value < 99.5 else f"{value:.0f}"


def beside(result, who):
    """What a contender is compared with: 95th percentiles with ours, all else with our one figure."""
    return result["ours_p95"] if who.endswith("_p95") else result["ours"]


def ratio_table(results):
    lines = ["| key | ours | others / ours |", "|---|---|---|"]
    for key, result in results.items():
        ours, unit = result["ours"], result["unit"]
        if unit == "s" or ours:
            others = [f"{who} {plainly(value / beside(result, who))}" for who, value in result["peers"].items()]
        else:
            others = [f"{who} {shown(value, unit)}" for who, value in result["peers"].items()]
        p95 = f", p95 {shown(result['ours_p95'], unit)}" if "ours_p95" in result else ""
        lines.append(f"| `{key}` | {shown(ours, unit)}{p95} | {', '.join(others)} |")
    return lines


def by_subject(results, suffix):
    """(subject, side, ours) of the keys subject/side + suffix whose side is a number."""
    for key, result in results.items():
        found = re.fullmatch(rf"([^/]+)/(\d+){suffix}", key)
        if found:
            yield found[1], found[2], result["ours"]


def put_paired(rows, results, what, digits):
    """What was measured in turns (bench/paired.h) takes the place of ratios of figures made one after the other."""
    for subject, side, ratio in by_subject(results, ""):
        found = re.fullmatch(rf"(.+)-{what}", subject)
        if found:
            rows.setdefault(found[1], {})[side] = f"{ratio:.{digits}f}"


def threads_table(results):
    rows = {}
    for subject, side, one in by_subject(results, "/t1"):
        two = results.get(f"{subject}/{side}/t2")
        if two:
            rows.setdefault(subject, {})[side] = f"{one / two['ours']:.2f}"
    put_paired(rows, results, "speedup", 2)
    return side_table(rows)


def growth_table(results):
    figures, rows = {}, {}
    for subject, side, ours in by_subject(results, "/t1"):
        figures.setdefault(subject, {})[int(side)] = ours
    for subject, of_side in figures.items():
        for side, ours in of_side.items():
            if side // 2 in of_side:
                rows.setdefault(subject, {})[str(side)] = f"{ours / of_side[side // 2]:.1f}"
    put_paired(rows, results, "growth", 1)
    return side_table(rows)


def side_table(rows):
    sides = [s for s in SIDES if any(s in row for row in rows.values())]
    lines = ["| work | " + " | ".join(sides) + " |", "|---" * (len(sides) + 1) + "|"]
    for subject, row in rows.items():
        lines.append(f"| {subject} | " + " | ".join(row.get(side, "") for side in sides) + " |")
    return lines


def replace(text, name, lines):
    pattern = rf"(<!-- {name}: from bench/results\.json -->\n).*?(<!-- end of {name} -->\n)"
    new, count = re.subn(pattern, lambda m: m[1] + "\n" + "\n".join(lines) + "\n\n" + m[2], text, flags=re.DOTALL)
    if count != 1:
        raise ValueError(f"there must be one place for the table '{name}'")
    return new


def write(path, results):
    with open(path, encoding="utf-8") as file:
        text = file.read()
    for name, table in (("ratios", ratio_table), ("two threads", threads_table), ("growth", growth_table)):
        text = replace(text, name, table(results))
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)

"""Prints what a day's best schedule is worth beside a greedy one.

Reads the days that `days_are_as_good_as_a_general_solver_makes_them` writes and the worth of their
best schedules, which `milp.py` writes. The greedy schedule takes the passes of the highest class
first and in each class the highest pass first, each where it fits beside those taken before.
"""

import json
import sys


def greedy(day):
    takes, limits = day["takes"], list(day["limits"])
    against = [set() for _ in takes]
    for a, b in day["conflicts"]:
        against[a].add(b)
        against[b].add(a)
    whole = [i for i, t in enumerate(takes) if t["possible"] and t["part"] == "alone"]
    whole.sort(key=lambda i: (takes[i]["class"], -takes[i]["height"], -takes[i]["worth"]))
    taken, passes, worth = set(), set(), [0] * 6
    for index in whole:
        take = takes[index]
        limit = take["limit"]
        if take["pass"] in passes or against[index] & taken:
            continue
        if limit is not None and limits[limit] == 0:
            continue
        if limit is not None:
            limits[limit] -= 1
        taken.add(index)
        passes.add(take["pass"])
        worth[take["class"] - 1] += take["worth"]
    return worth


def main(days, results):
    with open(results) as file:
        rows = [line for line in file if not line.startswith("#")]
    best = {int(row.split(",")[0]): [int(cell) for cell in row.split(",")[1:]] for row in rows}
    with open(days) as file:
        days = json.load(file)
    totals, firsts = [], []
    for day in days:
        ours, theirs = best[day["day"]], greedy(day)
        totals.append(100 * (sum(ours) / max(sum(theirs), 1) - 1))
        pairs = [(a, b) for a, b in zip(ours, theirs) if a != b]
        firsts.append(100 * (pairs[0][0] / max(pairs[0][1], 1) - 1) if pairs else 0.0)
    for name, gains in [("all classes", totals), ("first class that differs", firsts)]:
        mean = sum(gains) / len(gains)
        print(f"{name}: {mean:+.1f} % ({min(gains):+.1f} to {max(gains):+.1f} %), {len(gains)} days")


main(*sys.argv[1:])

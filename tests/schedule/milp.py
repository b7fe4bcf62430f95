"""Solves days of passes as MILPs with HiGHS, class after class.

Reads what `days_are_as_good_as_a_general_solver_makes_them` writes (its file has the commands) and
writes one row a day to the second file: its number, then what each class is worth at best.
"""

import json
import sys

import highspy

SEEDS = range(3)


def solve(day):
    takes = day["takes"]
    model = highspy.Highs()
    model.setOptionValue("output_flag", False)
    model.setOptionValue("mip_rel_gap", 0.0)
    model.setOptionValue("mip_abs_gap", 0.0004)
    model.setOptionValue("mip_feasibility_tolerance", 1e-9)
    model.setOptionValue("primal_feasibility_tolerance", 1e-9)
    x = [model.addBinary() for _ in takes]
    passes, seconds, limits = {}, {}, {}
    for variable, take in zip(x, takes):
        of = seconds if take["part"] == "second" else passes
        of.setdefault(take["pass"], []).append((variable, take["part"]))
        if take["limit"] is not None:
            limits.setdefault(take["limit"], []).append(variable)
        if not take["possible"]:
            model.addConstr(variable <= 0)
    for number, same in passes.items():
        if len(same) > 1:
            model.addConstr(sum(v for v, _ in same) <= 1)
        # One part of a pass counts only with the other.
        firsts = [v for v, part in same if part == "first"]
        others = [v for v, _ in seconds.pop(number, [])]
        if firsts or others:
            model.addConstr(sum(firsts) - sum(others) == 0)
    for alone in seconds.values():
        model.addConstr(sum(v for v, _ in alone) <= 0)
    for limit, same in limits.items():
        model.addConstr(sum(same) <= day["limits"][limit])
    for a, b in day["conflicts"]:
        model.addConstr(x[a] + x[b] <= 1)
    best, reached = [], []
    # Always, then priority 1 to 5; in seconds, which keeps the numbers small.
    for number in range(1, 7):
        own = [(v, t["worth"]) for v, t in zip(x, takes) if t["class"] == number]
        if not own:
            best.append(0)
            continue
        worth = sum(w / 1000 * v for v, w in own)
        # HiGHS 1.16 takes a worse solution for the best in about one class of 500, depending on its seed.
        solved = []
        for seed in SEEDS:
            model.clearSolver()
            model.setOptionValue("random_seed", seed)
            model.maximize(worth)
            values = list(model.getSolution().col_value)
            solved.append((sum(w for v, w in own if values[v.index] > 0.5), values))
        total, values = max(solved, key=lambda solution: solution[0])
        best.append(total)
        reached.append((own, total))
        # Within its tolerance, the solver may give up some of a class before.
        for before, least in reached:
            if sum(w for v, w in before if values[v.index] > 0.5) < least:
                raise SystemExit(f"day {day['day']}: class {number} costs a class before")
        model.addConstr(worth >= total / 1000 - 0.0004)
    return best


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        days = json.load(file)
    version = highspy.Highs().version()
    with open(sys.argv[2], "w", encoding="utf-8") as file:
        print(f"# HiGHS {version}: day, always, priority 1 to 5 (ms times sine)", file=file)
        for day in days:
            print(",".join(map(str, [day["day"], *solve(day)])), file=file, flush=True)



main()

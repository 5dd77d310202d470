"""Many runs of one scene: `flexarm sweep SCENE PLAN` (docs/sweep.md).

A plan (plan.py) says which values the parameters have in each run (designs.py) and what is measured (measures.py, with
expressions.py). perform() in run.py makes one run. processes.py and cluster.py make many runs at the same time, and
results.py saves the results.
"""

"""Many runs of one scene: `flexarm sweep SCENE PLAN`. docs/sweep.md

A plan (plan.py) says which values parameters have in each run (designs.py) and what is measured (measures.py, of
expressions.py). perform() of run.py is one run; processes.py and cluster.py let many of them go at once, and results.py
keeps what they give.
"""

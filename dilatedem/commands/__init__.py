"""Commands that stand in modules of their own; `cli` lists them. Each reads what the user typed, and calls the package."""

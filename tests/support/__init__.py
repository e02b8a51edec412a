"""What the tests share: fixtures (as pytest plugins), programs that tests start, and FMUs."""

"""Sections of docs/background/accuracy.md: text and figures from what the benchmarks measured."""

"""Tests of gaitlab.recording."""

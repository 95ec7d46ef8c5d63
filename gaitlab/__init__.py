"""Clinical gait analysis from inertial sensors on feet and knees."""

__version__ = "0.1.0"

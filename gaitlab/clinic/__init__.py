"""Use cases: permission, work and audit in one transaction; the only door for command line, REST and pages."""

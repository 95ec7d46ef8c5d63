"""Every published method by name: small pure functions, those that answer one question with one signature."""

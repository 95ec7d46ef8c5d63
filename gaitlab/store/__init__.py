"""Tables, files and the audit trail. Nothing here decides who may do what; everything is read through a site."""

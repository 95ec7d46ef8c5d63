"""Run by Alembic; the connection comes from gaitlab.store.schema, within the transaction it has begun."""

from alembic import context

from gaitlab.store.schema import METADATA

context.configure(
    connection=context.config.attributes["connection"],
    target_metadata=METADATA,
    compare_type=True,
    render_as_batch=True,
)
with context.begin_transaction():
    context.run_migrations()

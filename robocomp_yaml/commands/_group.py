"""A group of commands that says in one way, at every level, that a word is none of them."""

from __future__ import annotations

import click


class Group(click.Group):
    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        try:
            return super().resolve_command(ctx, args)
        except click.UsageError as error:
            if args[0].startswith("-"):  # an option that there is not
                raise
            meant = " or ".join(f"'{one}'" for one in self._meant(ctx, args[0]))
            said = f"there is no command '{' '.join([*ctx.command_path.split()[1:], args[0]])}'"
            raise click.UsageError(said + (f"; did you mean {meant}?" if meant else ""), ctx) from error

    def _meant(self, ctx: click.Context, word: str) -> list[str]:
        """A command of this group whose name is like the word, or those of its groups that are called so."""
        from robocomp_yaml.diag.suggest import suggest

        path = ctx.command_path.split()[1:]
        own = self.list_commands(ctx)
        groups = {name: found for name in own if isinstance(found := self.get_command(ctx, name), click.Group)}
        below = [f"{name} {word}" for name, group in groups.items() if word in group.commands]
        if below:
            return below
        meant = suggest(word, own)
        return [" ".join([*path, meant])] if meant else []

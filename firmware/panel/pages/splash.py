"""The first thing shown after power-on: what this is, and what it is not."""

from panel import texts


class Splash:
    """Takes no keys: those that act on every page act on this one too."""

    def take_keys(self, keys):
        pass

    def draw(self, screen, now_ms):
        screen.put(0, 0, texts.ROW_WIDTH, texts.SPLASH[0])
        screen.put(1, 0, texts.ROW_WIDTH, texts.SPLASH[1])

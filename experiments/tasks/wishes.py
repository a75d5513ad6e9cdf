"""What the user writes in every way, because the task is about it."""

VOLUME_ICE = """\
module RoboCompVolume
{
  interface Volume
  {
    void setVolume(int percent);
    int getVolume();
  };
};
"""

VOLUME_IDSL = """\
module RoboCompVolume
{
	interface Volume
	{
		void setVolume(int percent);
		int getVolume();
	};
};
"""

VOLUME_YAML = """\
module: RoboCompVolume
interfaces:
  Volume:
    methods:
      setVolume: {in: {percent: int}}
      getVolume: {returns: int}
"""

VOICE = '''\
"""How a text is spoken: abbreviations are written out, by templates of Jinja2."""

import jinja2


class Voice:
    WORDS = {"Dr.": "Doctor", "St.": "Street"}

    def __init__(self):
        source = "{% for word in text.split() %}{{ words.get(word, word) }}{{ ' ' if not loop.last }}{% endfor %}"
        self.template = jinja2.Template(source)

    def spoken(self, text):
        return self.template.render(text=text, words=self.WORDS)
'''

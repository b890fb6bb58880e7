"""Plots as HTML: lines and bands are an SVG that stretches; all text is HTML and stays readable on a phone.

Colours are CSS classes alone (page.css): the same plot serves light and dark.
"""

import html
import math

WIDTH, HEIGHT = 1000, 240  # of the drawing, stretched to what the page gives
COLUMNS = 900  # of decimation: each keeps its smallest and its largest value


def ticks(low, high, wanted=4):
    """Round numbers from low to high, some `wanted` of them."""
    raw = (high - low) / wanted
    power = 10 ** math.floor(math.log10(raw))
    step = next(power * m for m in (1, 2, 2.5, 5, 10) if power * m >= raw * 0.999)
    first = math.ceil(low / step - 1e-9)
    last = math.floor(high / step + 1e-9)
    return [i * step for i in range(first, last + 1)]


def angle_ticks(low, high):
    """The same for degrees, where 45 and its kin are round."""
    step = next((s for s in (45, 90, 180, 360, 720) if (high - low) / s <= 8), None)
    if high - low < 90 or step is None:
        return ticks(low, high)
    return [i * step for i in range(math.ceil(low / step), math.floor(high / step) + 1)]


def number(value):
    text = f"{value:.10g}"
    return "0" if text == "-0" else text.replace("-", "\u2212")


def decimated(times, values, begin, end, columns=COLUMNS):
    """Points of a line, at most two a column: what is left out lies between them."""
    if len(times) <= 2 * columns:
        return list(zip(times, values))
    points = []
    scale = columns / (end - begin)
    i = 0
    while i < len(times):
        column = int((times[i] - begin) * scale)
        low = high = i
        j = i
        while j < len(times) and int((times[j] - begin) * scale) == column:
            low = j if values[j] < values[low] else low
            high = j if values[j] > values[high] else high
            j += 1
        points += [(times[k], values[k]) for k in sorted({low, high})]
        i = j
    return points


class Plot:
    """One panel over time. Add what is to be seen, then ask for its html()."""

    def __init__(self, title, unit, begin, end, low=None, high=None, is_angle=False):
        self.title, self.unit = title, unit
        self.begin, self.end = begin, end
        self.low, self.high, self.is_angle = low, high, is_angle
        self.lines, self.levels, self.bands, self.spans, self.marks = [], [], [], [], []

    def line(self, times, values, kind, label, wraps=None):
        """A curve; `wraps`: a jump of more than this is no motion, and not drawn."""
        pairs = [(t, v) for t, v in zip(times, values) if self.begin <= t <= self.end]
        self.lines.append(([t for t, _ in pairs], [v for _, v in pairs], kind, label, wraps))

    def level(self, value, kind, label):
        """A horizontal line: a limit, a target. It is drawn when it is in sight."""
        self.levels.append((value, kind, label))

    def band(self, low, high, kind, label):
        self.bands.append((low, high, kind, label))

    def modes(self, spans):
        self.spans = spans

    def faults(self, faults):
        self.marks = faults

    def _range(self):
        values = [v for _, vs, *_ in self.lines for v in vs] or [0]
        low, high = min(values), max(values)
        near = (high - low) * 0.5 or max(abs(high), 1e-9)
        for value, *_ in self.levels:
            if low - near <= value <= high + near:  # a limit far away would flatten the curve
                low, high = min(low, value), max(high, value)
        margin = 0.06 * ((high - low) or abs(high) or 1)
        self.low = low - margin if self.low is None else self.low
        self.high = high + margin if self.high is None else self.high

    def x(self, time):
        return WIDTH * (time - self.begin) / (self.end - self.begin)

    def y(self, value):
        return HEIGHT * (self.high - value) / (self.high - self.low)

    def _path(self, times, values, wraps):
        strokes = []
        start = 0
        for i in range(1, len(times) + 1):
            if i == len(times) or (wraps is not None and abs(values[i] - values[i - 1]) > wraps):
                columns = max(2, round(COLUMNS * (i - start) / max(1, len(times))))
                piece_begin, piece_end = times[start], times[i - 1]
                points = decimated(
                    times[start:i],
                    values[start:i],
                    piece_begin,
                    piece_end + 1e-12 + (piece_end - piece_begin) * 1e-9,
                    columns,
                )
                strokes.append("M" + "L".join(f"{self.x(t):.1f} {self.y(v):.1f}" for t, v in points))
                start = i
        return "".join(strokes)

    def _drawing(self):
        parts = []
        for span in self.spans:
            left, right = self.x(max(span.begin, self.begin)), self.x(min(span.end, self.end))
            if right > left:
                parts.append(
                    f'<rect class="mode {span.mode}" x="{left:.1f}" width="{right - left:.1f}" '
                    f'y="0" height="{HEIGHT}"/>'
                )
        for value in self.x_ticks:
            parts.append(f'<path class="grid" d="M{self.x(value):.1f} 0V{HEIGHT}"/>')
        for value in self.y_ticks:
            kind = "grid zero" if value == 0 else "grid"
            parts.append(f'<path class="{kind}" d="M0 {self.y(value):.1f}H{WIDTH}"/>')
        for low, high, kind, _ in self.bands:
            top, bottom = max(self.y(high), 0), min(self.y(low), HEIGHT)
            parts.append(
                f'<rect class="band {kind}" x="0" width="{WIDTH}" y="{top:.1f}" '
                f'height="{max(bottom - top, 1.5):.1f}"/>'
            )
        for value, kind, _ in self.levels:
            if self.low <= value <= self.high:
                parts.append(f'<path class="level {kind}" d="M0 {self.y(value):.1f}H{WIDTH}"/>')
        for times, values, kind, _, wraps in self.lines:
            if times:
                parts.append(f'<path class="line {kind}" d="{self._path(times, values, wraps)}"/>')
        for time, _ in self.marks:
            if self.begin <= time <= self.end:
                parts.append(f'<path class="fault" d="M{self.x(time):.1f} 0V{HEIGHT}"/>')
        return "".join(parts)

    def _key(self):
        entries = [(kind, label, "line") for _, _, kind, label, _ in self.lines if label]
        entries += [(kind, label, "band") for _, _, kind, label in self.bands if label]
        entries += [
            (kind, label, "level")
            for value, kind, label in self.levels
            if label and self.low <= value <= self.high
        ]
        seen = dict.fromkeys(entries)
        return "".join(
            f'<span class="key"><i class="swatch {shape} {kind}"></i>{html.escape(label)}</span>'
            for kind, label, shape in seen
        )

    def html(self, shows_time=True):
        self._range()
        self.x_ticks = ticks(self.begin, self.end, 6)
        self.y_ticks = (angle_ticks if self.is_angle else ticks)(self.low, self.high)
        y_labels = "".join(
            f'<span style="top:{100 * self.y(v) / HEIGHT:.2f}%">{number(v)}</span>' for v in self.y_ticks
        )
        x_labels = (
            "".join(
                f'<span style="left:{100 * self.x(v) / WIDTH:.2f}%"{" class=odd" if i % 2 else ""}>'
                f'{number(v)}</span>'
                for i, v in enumerate(self.x_ticks)
            )
            if shows_time
            else ""
        )
        marks = (
            "".join(
                f'<b style="left:{100 * self.x(t) / WIDTH:.2f}%">{html.escape(name)}</b>'
                for t, name in self.marks
                if self.begin <= t <= self.end
            )
            if shows_time
            else ""
        )
        label = html.escape(f"{self.title} over time", quote=True)
        return (
            f'<figure class="plot"><figcaption><b>{html.escape(self.title)}</b> <span class="unit">'
            f'{html.escape(self.unit)}'
            f'</span>{self._key()}</figcaption><div class="area"><svg role="img" aria-label="{label}" '
            f'viewBox="0 0 {WIDTH} {HEIGHT}" preserveAspectRatio="none">{self._drawing()}</svg>'
            f'<div class="y">{y_labels}</div><div class="x">{x_labels}</div><div class="marks">'
            f'{marks}</div></div></figure>'
        )

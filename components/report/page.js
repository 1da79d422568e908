'use strict';
// Draws the plots and the map of a flight report from the data in the page, and lets them show one
// moment together. What it puts into the page is text and shapes, never markup.
const root = document.documentElement;
function complain(what) {
  root.dataset.errors = (root.dataset.errors ? root.dataset.errors + '; ' : '') + what;
}
window.addEventListener('error', (event) => complain(event.message));
document.addEventListener('securitypolicyviolation', (event) => complain('blocked: ' + event.blockedURI));

const data = JSON.parse(document.getElementById('data').textContent);
const view = {from: 0, to: Math.max(data.duration, 1e-3)};
let cursor = null;
const drawings = [];  // each has draw() and show()
const margin = {left: 52, right: 10, top: 6, bottom: 20};

// --- small tools ---------------------------------------------------------------------------
function shape(name, attributes, parent, text) {
  const element = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const key in attributes) element.setAttribute(key, attributes[key]);
  if (text !== undefined) element.textContent = text;
  if (parent) parent.appendChild(element);
  return element;
}
function tag(name, className, parent, text) {
  const element = document.createElement(name);
  if (className) element.className = className;
  if (text !== undefined) element.textContent = text;
  parent.appendChild(element);
  return element;
}
function slug(mode) { return mode.toLowerCase().replace(/[^a-z]+/g, '-'); }
function modeColour(mode) { return `var(--m-${slug(mode)}, var(--m-grounded))`; }
function modeAt(time) {
  const span = data.modes.find((m) => time >= m[0] && time < m[1]);
  return span ? span[2] : '';
}
// A round step that cuts `range` into at most `most` parts.
function roundStep(range, most) {
  const raw = range / Math.max(most, 1);
  const power = Math.pow(10, Math.floor(Math.log10(raw)));
  return [1, 2, 5, 10].map((f) => f * power).find((step) => step >= raw * 0.999);
}
function timeStep(range, most) {
  const steps = [1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 14400, 43200, 86400];
  return range < 2 * most ? roundStep(range, most) : steps.find((s) => range / s <= most) || roundStep(range, most);
}
function timeText(time, step) {
  if (data.duration < 180) return time.toFixed(step < 1 ? Math.min(3, Math.ceil(-Math.log10(step))) : 0) + ' s';
  const whole = Math.floor(time);
  const two = (n) => String(n).padStart(2, '0');
  const fraction = step < 1 ? (time - whole).toFixed(Math.min(3, Math.ceil(-Math.log10(step)))).slice(1) : '';
  const hours = Math.floor(whole / 3600);
  const minutes = Math.floor(whole / 60) % 60;
  return (hours > 0 ? hours + ':' + two(minutes) : minutes) + ':' + two(whole % 60) + fraction;
}
function number(value, digits) { return value.toFixed(digits).replace(/^-(0(\.0*)?)$/, '$1'); }

// Times come as differences in milliseconds; a line begins where the list of beginnings says.
function unpack(series) {
  let time = 0;
  series.time = series.t.map((d) => (time += d) / 1000);
  series.begins = new Set(series.b);
}
function nearest(times, time) {
  let low = 0, high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] < time) low = middle + 1; else high = middle;
  }
  if (low === times.length) return low - 1;
  return low > 0 && time - times[low - 1] < times[low] - time ? low - 1 : low;
}

// --- plots over time -----------------------------------------------------------------------
class TimePlot {
  constructor(figure, plot) {
    this.plot = plot;
    plot.series.forEach(unpack);
    const caption = tag('figcaption', '', figure);
    tag('strong', '', caption, plot.title + (plot.unit ? ' [' + plot.unit + ']' : ''));
    this.values = plot.series.map((series) => {
      const key = tag('span', 'key', series.name ? caption : document.createDocumentFragment());
      const swatch = tag('i', series.look, key);
      if (['setpoint', 'limit'].includes(series.look)) swatch.classList.add('dashed');
      key.appendChild(document.createTextNode(series.name));
      return tag('b', '', key);
    });
    this.svg = shape('svg', {role: 'img', 'aria-label': plot.title}, figure);
    followPointer(this.svg);
  }
  draw() {
    const width = this.svg.parentNode.clientWidth || 700;
    const height = width < 500 ? 130 : 150;
    const svg = begin(this.svg, width, height);
    const x = timeScale(width);
    const [low, high] = this.range();
    const bottom = height - margin.bottom;
    const y = (v) => bottom - (v - low) / (high - low) * (bottom - margin.top);
    drawBands(svg, x, margin.top, bottom);
    const step = roundStep(high - low, 4);
    const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    for (let v = Math.ceil(low / step) * step; v <= high; v += step) {
      shape('line', {x1: margin.left, x2: width - margin.right, y1: y(v), y2: y(v), class: 'grid'}, svg);
      shape('text', {x: margin.left - 6, y: y(v) + 4, 'text-anchor': 'end'}, svg, number(v, digits));
    }
    drawTimes(svg, x, width, bottom);
    const clip = shape('svg', {x: margin.left, y: margin.top, width: width - margin.left - margin.right,
                               height: bottom - margin.top, viewBox:
                               `${margin.left} ${margin.top} ${width - margin.left - margin.right} ${bottom - margin.top}`}, svg);
    for (const series of this.plot.series) {
      let path = '';
      for (let i = 0; i < series.time.length; ++i) {
        path += (series.begins.has(i) ? 'M' : 'L') + x(series.time[i]).toFixed(1) + ' ' + y(series.v[i]).toFixed(1);
      }
      shape('path', {d: path, class: 'line ' + series.look}, clip);
    }
    shape('rect', {x: margin.left, y: margin.top, width: width - margin.left - margin.right,
                   height: bottom - margin.top, class: 'frame'}, svg);
    this.line = cursorLine(svg, bottom);
    this.x = x;
  }
  // Of what is in view, with some air around.
  range() {
    let low = Infinity, high = -Infinity;
    for (const series of this.plot.series) {
      for (let i = 0; i < series.time.length; ++i) {
        if (series.time[i] < view.from || series.time[i] > view.to) continue;
        low = Math.min(low, series.v[i]);
        high = Math.max(high, series.v[i]);
      }
    }
    if (low > high) [low, high] = [0, 1];
    const least = Math.pow(10, -this.plot.digits) * 5;
    const air = Math.max((high - low) * 0.07, (least - (high - low)) / 2, 1e-9);
    return [low - air, high + air];
  }
  show() {
    showLine(this.line, this.x);
    this.plot.series.forEach((series, i) => {
      const at = cursor === null || series.time.length === 0 ? -1 : nearest(series.time, cursor);
      const near = at >= 0 && Math.abs(series.time[at] - cursor) <= this.plot.reach;
      this.values[i].textContent = near ? number(series.v[at], this.plot.digits) : '';
    });
  }
}
function begin(svg, width, height) {
  svg.replaceChildren();
  svg.setAttribute('viewBox', `0 0 ${width} ${height}`);
  return svg;
}
function timeScale(width) {
  const inner = width - margin.left - margin.right;
  return (time) => margin.left + (time - view.from) / (view.to - view.from) * inner;
}
function drawBands(svg, x, top, bottom, label) {
  for (const [from, to, mode] of data.modes) {
    const left = x(Math.max(from, view.from)), right = x(Math.min(to, view.to));
    if (right <= left) continue;
    const band = shape('rect', {x: left, y: top, width: right - left, height: bottom - top, class: 'band'}, svg);
    band.style.fill = modeColour(mode);
    band.style.fillOpacity = slug(mode) === 'grounded' ? 'calc(var(--band) * .45)' : label ? 'calc(var(--band) * 2.4)' : 'var(--band)';
    if (!label) continue;
    shape('title', {}, band, mode);
    if (right - left > mode.length * 6.3 + 8) {
      shape('text', {x: (left + right) / 2, y: (top + bottom) / 2 + 4, 'text-anchor': 'middle', class: 'word'}, svg, mode);
    }
  }
}
function drawTimes(svg, x, width, bottom) {
  const step = timeStep(view.to - view.from, Math.floor(width / 80));
  for (let t = Math.ceil(view.from / step - 1e-9) * step; t <= view.to + 1e-9; t += step) {
    shape('line', {x1: x(t), x2: x(t), y1: margin.top, y2: bottom, class: 'grid'}, svg);
    const anchor = x(t) > width - 25 ? 'end' : 'middle';
    shape('text', {x: x(t), y: bottom + 14, 'text-anchor': anchor}, svg, timeText(t, step));
  }
}
function cursorLine(svg, bottom) {
  return shape('line', {y1: 0, y2: bottom, class: 'cursor', visibility: 'hidden'}, svg);
}
function showLine(line, x) {
  const seen = cursor !== null && cursor >= view.from && cursor <= view.to;
  line.setAttribute('visibility', seen ? 'visible' : 'hidden');
  if (!seen) return;
  line.setAttribute('x1', x(cursor));
  line.setAttribute('x2', x(cursor));
}

// --- the modes, on top ---------------------------------------------------------------------
class Ribbon {
  constructor(element) {
    this.now = element.querySelector('.now');
    this.time = tag('b', '', this.now);
    this.mode = tag('span', '', this.now);
    this.clock = tag('span', '', this.now);
    this.back = tag('button', '', this.now, 'whole flight');
    this.back.addEventListener('click', () => setView(0, Math.max(data.duration, 1e-3)));
    this.svg = shape('svg', {role: 'img', 'aria-label': 'Modes over time'}, element);
    followPointer(this.svg);
  }
  draw() {
    const width = this.svg.parentNode.clientWidth || 700;
    const svg = begin(this.svg, width, 46);
    const x = timeScale(width);
    drawTimes(svg, x, width, 28);
    drawBands(svg, x, 8, 28, true);
    for (const [time, level] of data.marks) {
      if (time < view.from || time > view.to) continue;
      shape('path', {d: `M${x(time) - 4} 1h8l-4 7z`, class: 'mark ' + level}, svg);
    }
    this.line = cursorLine(svg, 28);
    this.x = x;
    this.back.hidden = view.from <= 0 && view.to >= data.duration;
  }
  show() {
    showLine(this.line, this.x);
    const idle = cursor === null;
    this.time.textContent = idle ? '' : timeText(cursor, 0.01);
    this.mode.textContent = idle ? 'Point at a plot: all show that moment. Drag: a closer look.' : modeAt(cursor);
    this.clock.textContent = idle || data.epoch === null ? '' :
        new Date(data.epoch + cursor * 1000).toISOString().slice(0, 23).replace('T', ' ') + ' UTC';
  }
}

// --- the map -------------------------------------------------------------------------------
class MapView {
  constructor(figure, map) {
    this.map = map;
    unpack(map.flown);
    this.svg = shape('svg', {role: 'img', 'aria-label': 'Map with the flown track'}, figure);
    const flown = [...new Set(map.flown.time.map(modeAt))].filter((mode) => mode);
    const caption = tag('figcaption', '', figure);
    for (const mode of flown) this.key(caption, mode).style.borderTopColor = modeColour(mode);
    if (flown.length === 0 && map.flown.x.length > 0) this.key(caption, 'flown').className = 'estimate';
    if (map.asked.x.length > 0) this.key(caption, 'setpoint').className = 'limit dashed';
    for (const [kind, word] of [['goal', 'goal'], ['waypoint', 'waypoint'], ['contact', 'contact'], ['guard', 'guard acts']]) {
      if (!map.places.some((place) => place.kind === kind)) continue;
      const key = tag('span', 'key', caption);
      const icon = shape('svg', {viewBox: '-8 -8 16 16'}, key);
      icon.style.cssText = 'display:inline;width:16px;height:16px;vertical-align:-3px;background:none;margin-right:.3em';
      this.symbol(icon, kind, 0, 0);
      key.appendChild(document.createTextNode(word));
    }
    this.svg.addEventListener('pointermove', (event) => this.point(event));
    this.svg.addEventListener('pointerdown', (event) => this.point(event));
    this.svg.addEventListener('pointerleave', () => setCursor(null));
  }
  key(caption, word) {
    const key = tag('span', 'key', caption);
    const swatch = tag('i', '', key);
    key.appendChild(document.createTextNode(word));
    return swatch;
  }
  draw() {
    const {lower, upper} = this.map;
    const width = this.svg.parentNode.clientWidth || 700;
    const size = [upper[0] - lower[0], upper[1] - lower[1]];
    const scale = Math.min((width - 8) / size[0], Math.max(260, Math.min(620, width)) / size[1]);
    const height = Math.max(120, size[1] * scale + 8);
    const left = (width - size[0] * scale) / 2;
    const svg = begin(this.svg, width, height);
    const x = this.x = (v) => left + (v - lower[0]) * scale;
    const y = this.y = (v) => height - 4 - (v - lower[1]) * scale;
    const picture = this.map.picture;
    if (picture) {
      shape('image', {href: picture.png, x: x(picture.lower[0]), y: y(picture.upper[1]), preserveAspectRatio: 'none',
                      width: (picture.upper[0] - picture.lower[0]) * scale,
                      height: (picture.upper[1] - picture.lower[1]) * scale}, svg);
    }
    const step = roundStep(width / scale, width / 90);
    for (let v = Math.ceil(lower[0] / step) * step; v < upper[0]; v += step) {
      shape('line', {x1: x(v), x2: x(v), y1: height - 5, y2: height, class: 'frame'}, svg);
      shape('text', {x: x(v), y: height - 8, 'text-anchor': 'middle'}, svg, number(v, step < 1 ? 1 : 0));
    }
    for (let v = Math.ceil(lower[1] / step) * step; v < upper[1]; v += step) {
      shape('line', {x1: 0, x2: 5, y1: y(v), y2: y(v), class: 'frame'}, svg);
      shape('text', {x: 8, y: y(v) + 4}, svg, number(v, step < 1 ? 1 : 0));
    }
    const asked = this.map.asked;
    let way = '';
    asked.x.forEach((v, i) => { way += (i ? 'L' : 'M') + x(v).toFixed(1) + ' ' + y(asked.y[i]).toFixed(1); });
    if (way) shape('path', {d: way, class: 'asked'}, svg);
    this.drawFlown(svg, x, y);
    this.drawPlaces(svg, x, y);
    const bar = roundStep(90 / scale, 1) || 1;
    shape('line', {x1: width - 12 - bar * scale, x2: width - 12, y1: height - 24, y2: height - 24, class: 'bar'}, svg);
    shape('text', {x: width - 12, y: height - 29, 'text-anchor': 'end', class: 'label'}, svg, bar + ' m');
    this.here = shape('circle', {r: 5.5, class: 'here', visibility: 'hidden'}, svg);
  }
  drawFlown(svg, x, y) {
    const {time, x: px, y: py} = this.map.flown;
    let path = '', mode = null;
    const finish = () => {
      if (!path) return;
      const line = shape('path', {d: path, class: 'line flown' + (mode ? '' : ' estimate')}, svg);
      if (mode) line.style.stroke = modeColour(mode);
    };
    for (let i = 0; i < time.length; ++i) {
      const at = `${x(px[i]).toFixed(1)} ${y(py[i]).toFixed(1)}`;
      const now = modeAt(time[i]);
      if (now !== mode) {
        if (path) path += 'L' + at;
        finish();
        path = 'M' + at;
        mode = now;
      } else {
        path += 'L' + at;
      }
    }
    finish();
  }
  drawPlaces(svg, x, y) {
    for (const place of this.map.places) {
      const px = x(place.x), py = y(place.y);
      const group = shape('g', {}, svg);
      shape('title', {}, group, place.label + ' at ' + timeText(place.t, 0.1));
      this.symbol(group, place.kind, px, py);
      if (place.kind === 'takeoff') shape('text', {x: px, y: py - 12, 'text-anchor': 'middle', class: 'label'}, group, 'take-off');
      if (place.kind === 'landing') shape('text', {x: px, y: py + 21, 'text-anchor': 'middle', class: 'label'}, group, 'landing');
      if (place.kind === 'waypoint') shape('text', {x: px + 9, y: py + 4, class: 'label'}, group, place.label);
    }
  }
  symbol(parent, kind, x, y) {
    if (kind === 'takeoff') return shape('path', {d: `M${x} ${y - 8}l7 12h-14z`, class: 'place'}, parent);
    if (kind === 'landing') return shape('path', {d: `M${x} ${y + 8}l7 -12h-14z`, class: 'place'}, parent);
    if (kind === 'waypoint') return shape('rect', {x: x - 5, y: y - 5, width: 10, height: 10, class: 'place'}, parent);
    if (kind === 'contact') return shape('path', {d: `M${x - 6} ${y - 6}l12 12M${x + 6} ${y - 6}l-12 12`, class: 'contact'}, parent);
    if (kind === 'guard') return shape('path', {d: `M${x} ${y - 6}l6 6l-6 6l-6 -6z`, class: 'guard'}, parent);
    return shape('circle', {cx: x, cy: y, r: 4, class: 'goal'}, parent);
  }
  point(event) {
    const box = this.svg.getBoundingClientRect();
    const width = this.svg.viewBox.baseVal.width;
    const px = (event.clientX - box.left) * width / box.width, py = (event.clientY - box.top) * width / box.width;
    let best = -1, least = 30 * 30;
    this.map.flown.time.forEach((time, i) => {
      const d = (this.x(this.map.flown.x[i]) - px) ** 2 + (this.y(this.map.flown.y[i]) - py) ** 2;
      if (d < least) [best, least] = [i, d];
    });
    setCursor(best < 0 ? null : this.map.flown.time[best]);
  }
  show() {
    const {time, x, y} = this.map.flown;
    const at = cursor === null || time.length === 0 ? -1 : nearest(time, cursor);
    this.here.setAttribute('visibility', at >= 0 ? 'visible' : 'hidden');
    if (at < 0) return;
    this.here.setAttribute('cx', this.x(x[at]));
    this.here.setAttribute('cy', this.y(y[at]));
  }
}

// --- one moment, one view, for all ---------------------------------------------------------
function timeAt(svg, clientX) {
  const box = svg.getBoundingClientRect();
  const width = svg.viewBox.baseVal.width;
  const px = (clientX - box.left) * width / box.width;
  const time = view.from + (px - margin.left) / (width - margin.left - margin.right) * (view.to - view.from);
  return Math.min(Math.max(time, view.from), view.to);
}
function followPointer(svg) {
  let from = null, pick = null;
  svg.addEventListener('pointermove', (event) => {
    const time = timeAt(svg, event.clientX);
    setCursor(time);
    if (from === null) return;
    const x = timeScale(svg.viewBox.baseVal.width);
    if (!pick) pick = shape('rect', {y: margin.top, height: svg.viewBox.baseVal.height, class: 'pick'}, svg);
    pick.setAttribute('x', x(Math.min(from, time)));
    pick.setAttribute('width', Math.abs(x(time) - x(from)));
  });
  svg.addEventListener('pointerdown', (event) => {
    setCursor(timeAt(svg, event.clientX));
    if (event.pointerType !== 'mouse' || event.button !== 0) return;
    event.preventDefault();
    from = timeAt(svg, event.clientX);
    svg.setPointerCapture(event.pointerId);
  });
  svg.addEventListener('pointerup', (event) => {
    const to = timeAt(svg, event.clientX);
    const wide = from !== null && Math.abs(to - from) > 0.01 * (view.to - view.from);
    if (pick) pick.remove();
    if (wide) setView(Math.min(from, to), Math.max(from, to));
    from = pick = null;
  });
  svg.addEventListener('pointerleave', () => { if (from === null) setCursor(null); });
  svg.addEventListener('dblclick', () => setView(0, Math.max(data.duration, 1e-3)));
}
function setCursor(time) {
  cursor = time;
  for (const drawing of drawings) drawing.show();
}
function setView(from, to) {
  view.from = from;
  view.to = to;
  drawAll();
}
function drawAll() {
  for (const drawing of drawings) {
    drawing.draw();
    drawing.show();
  }
}

// --- events --------------------------------------------------------------------------------
function setUpEvents(table) {
  const rows = [...table.querySelectorAll('tbody tr')];
  for (const row of rows) {
    row.addEventListener('pointerenter', () => setCursor(Number(row.dataset.time)));
    row.addEventListener('pointerleave', () => setCursor(null));
    row.addEventListener('click', () => {
      const time = Number(row.dataset.time);
      const half = Math.min(data.duration / 2, 5);
      setView(Math.max(0, time - half), Math.min(data.duration, time + half));
      setCursor(time);
    });
  }
  const filters = document.getElementById('filters');
  for (const kind of [...new Set(rows.map((row) => row.dataset.kind))].sort()) {
    const label = tag('label', '', filters);
    const box = tag('input', '', label);
    box.type = 'checkbox';
    box.checked = true;
    const mine = rows.filter((row) => row.dataset.kind === kind);
    label.appendChild(document.createTextNode(` ${kind} (${mine.length})`));
    box.addEventListener('change', () => { for (const row of mine) row.hidden = !box.checked; });
  }
}

drawings.push(new Ribbon(document.getElementById('ribbon')));
for (const figure of document.querySelectorAll('figure[data-plot]')) {
  drawings.push(new TimePlot(figure, data.plots[Number(figure.dataset.plot)]));
}
const mapFigure = document.getElementById('map');
if (mapFigure && data.map) drawings.push(new MapView(mapFigure, data.map));
const events = document.getElementById('events');
if (events) setUpEvents(events);
drawAll();
let drawnWidth = document.body.clientWidth;
window.addEventListener('resize', () => {
  if (document.body.clientWidth === drawnWidth) return;
  drawnWidth = document.body.clientWidth;
  drawAll();
});
document.addEventListener('keydown', (event) => {
  if (event.key === 'Escape') setView(0, Math.max(data.duration, 1e-3));
  const step = {ArrowLeft: -1, ArrowRight: 1}[event.key];
  if (!step || event.target.tagName === 'INPUT') return;
  event.preventDefault();
  const next = (cursor === null ? view.from : cursor) + step * (view.to - view.from) / 200;
  setCursor(Math.min(Math.max(next, view.from), view.to));
});
root.dataset.drawn = String(drawings.length);

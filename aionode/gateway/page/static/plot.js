// Draws numbers over time on a canvas.

const COLOURS = ["#3b8eea", "#e8862e", "#2ea36b", "#d9485f", "#9a6be0", "#b0932b"];
const MAX_POINTS = 6000;
const MAX_GRID_LINES = 8; // of large numbers, a step may be too small to make a difference
const MARGIN = { left: 52, right: 8, top: 8, bottom: 20 };

/** Lines of numbers, the newest at the right edge. */
export class Plot {
  constructor(canvas, seconds = 30) {
    this.canvas = canvas;
    this.seconds = seconds;
    this.lines = new Map();
    const draw = () => {
      this.draw(performance.now() / 1000);
      requestAnimationFrame(draw);
    };
    requestAnimationFrame(draw);
  }

  /** Start a line, and return its colour. */
  add(name) {
    const used = new Set([...this.lines.values()].map((line) => line.colour));
    const colour = COLOURS.find((each) => !used.has(each)) ?? COLOURS[0];
    this.lines.set(name, { colour, points: [] });
    return colour;
  }

  remove(name) {
    this.lines.delete(name);
  }

  push(name, value) {
    const points = this.lines.get(name)?.points;
    if (!points) return;
    const now = performance.now() / 1000;
    points.push([now, value]);
    const old = points.findIndex(([time]) => time > now - this.seconds - 1);
    if (old > 100) points.splice(0, old);
    if (points.length > MAX_POINTS) points.splice(0, points.length - MAX_POINTS);
  }

  draw(now) {
    const { canvas, seconds } = this;
    const scale = devicePixelRatio;
    const width = canvas.clientWidth, height = canvas.clientHeight;
    if (canvas.width !== Math.round(width * scale)) canvas.width = Math.round(width * scale);
    if (canvas.height !== Math.round(height * scale)) canvas.height = Math.round(height * scale);
    const context = canvas.getContext("2d");
    context.setTransform(scale, 0, 0, scale, 0, 0);
    context.clearRect(0, 0, width, height);
    if (!this.lines.size) return;
    const [low, high] = this.range(now);
    const x = (time) => width - MARGIN.right - (now - time) * (width - MARGIN.left - MARGIN.right) / seconds;
    const y = (value) => height - MARGIN.bottom - (value - low) * (height - MARGIN.top - MARGIN.bottom) / (high - low);
    this.drawGrid(context, now, low, high, x, y);
    context.save();
    context.beginPath();
    context.rect(MARGIN.left, 0, width - MARGIN.left - MARGIN.right, height);
    context.clip();
    context.lineWidth = 1.5;
    for (const { colour, points } of this.lines.values()) {
      context.strokeStyle = colour;
      context.beginPath();
      for (const [time, value] of points) if (Number.isFinite(value)) context.lineTo(x(time), y(value));
      context.stroke();
    }
    context.restore();
  }

  range(now) {
    let low = Infinity, high = -Infinity;
    for (const { points } of this.lines.values()) {
      for (const [time, value] of points) {
        if (time < now - this.seconds || !Number.isFinite(value)) continue;
        low = Math.min(low, value);
        high = Math.max(high, value);
      }
    }
    if (low > high) return [-1, 1];
    const spare = (high - low) * 0.08 || Math.abs(high) * 0.1 || 1;
    return [low - spare, high + spare];
  }

  drawGrid(context, now, low, high, x, y) {
    const style = getComputedStyle(this.canvas);
    context.strokeStyle = "rgb(128 128 128 / 30%)";
    context.fillStyle = style.color;
    context.font = "11px system-ui, sans-serif";
    context.lineWidth = 1;
    const step = niceStep((high - low) / 5);
    context.textAlign = "right";
    let value = Math.ceil(low / step) * step;
    for (let count = 0; count < MAX_GRID_LINES && value <= high; count++, value += step) {
      line(context, x(now - this.seconds), y(value), x(now), y(value));
      context.fillText(Number(value.toPrecision(6)).toString(), MARGIN.left - 6, y(value) + 4);
    }
    context.textAlign = "center";
    for (let ago = 0; ago < this.seconds; ago += 10) {
      line(context, x(now - ago), y(low), x(now - ago), y(high));
      if (ago) context.fillText(`−${ago} s`, x(now - ago), y(low) + 14);
    }
  }
}

function line(context, fromX, fromY, toX, toY) {
  context.beginPath();
  context.moveTo(fromX, fromY);
  context.lineTo(toX, toY);
  context.stroke();
}

function niceStep(rough) {
  const power = 10 ** Math.floor(Math.log10(rough));
  return [1, 2, 5, 10].map((digit) => digit * power).find((step) => step >= rough);
}

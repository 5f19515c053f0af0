// Draws the figures of the page from the data in it, again where the width changes, and makes the table behind a figure
// when it is opened.
"use strict";
(() => {
  const report = JSON.parse(document.getElementById("figures").textContent);

  async function draw(figure) {
    const place = document.querySelector(`#figure-${CSS.escape(figure.name)} .plot`);
    const width = Math.floor(place.getBoundingClientRect().width);
    if (width === figure.width) return;
    figure.width = width;
    // ast: expressions are interpreted, because the security policy of the page forbids eval.
    await vegaEmbed(place, completed(figure, report.theme, width),
      {renderer: "svg", actions: false, ast: true, defaultStyle: true, logLevel: vega.Warn});
    place.dataset.drawn = "yes";
  }

  const number = value => {
    if (typeof value !== "number") return value ?? "–";
    if (value === 0 || Number.isInteger(value) && Math.abs(value) < 1e7) return String(value);
    const size = Math.abs(value);
    return size < 1e-3 || size >= 1e7 ? value.toExponential(3) : String(Number(value.toPrecision(5)));
  };

  function table(data) {
    const shown = data.columns.map((column, i) => [column, i]).filter(([[, title]]) => title !== "");
    const element = document.createElement("table");
    const head = element.createTHead().insertRow();
    for (const [[, title, unit]] of shown) {
      const cell = document.createElement("th");
      cell.textContent = title;
      if (unit === "") cell.className = "text";
      if (unit !== "" && unit !== "1") {
        const small = document.createElement("span");
        small.className = "unit";
        small.textContent = unit;
        cell.append(small);
      }
      head.append(cell);
    }
    const body = element.createTBody();
    for (const row of data.rows) {
      const line = body.insertRow();
      for (const [[, title, unit], i] of shown) {
        const cell = line.insertCell();
        cell.dataset.head = title;
        cell.textContent = number(row[i]);
        if (unit === "") cell.className = "text";
      }
    }
    return element;
  }

  for (const figure of report.figures) {
    const details = document.querySelector(`#figure-${CSS.escape(figure.name)} details`);
    details.addEventListener("toggle", () => {
      const place = details.querySelector(".scroll");
      if (details.open && !place.hasChildNodes()) place.append(table(figure.data[0]));
    });
  }

  let drawing = Promise.resolve();
  const drawAll = () => {
    drawing = drawing.then(async () => {
      for (const figure of report.figures) await draw(figure);
      document.documentElement.dataset.drawn = "yes";
    });
    return drawing;
  };
  let waiting;
  addEventListener("resize", () => {
    clearTimeout(waiting);
    waiting = setTimeout(drawAll, 150);
  });
  drawAll();
})();

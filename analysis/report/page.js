// Draws the figures of the page from the data in it, again where the width changes.
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

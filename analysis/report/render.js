// Draws one figure without a browser: run by node after vega, vega-lite and figures.js, with the `figure`, its `theme` and the `colours`
// of a light page. Writes to standard output the picture as SVG, or where that is `wanted`, the specification, which needs nothing else.
"use strict";
(async () => {
  // Without a browser, Vega guesses that all letters are wide.
  const narrow = /[iljtfrI.,:;'|()[\]{}! ]/g;
  vega.textMetrics.width = (item, text) => {
    const letters = String(text ?? item.text ?? "");
    const thin = (letters.match(narrow) ?? []).length;
    return (item.fontSize ?? 11) * (0.58 * (letters.length - thin) + 0.32 * thin);
  };
  const specification = completed(figure, {...theme, background: "white"}, 560, colours);
  if (wanted === "specification") {
    process.stdout.write(JSON.stringify(specification) + "\n");
    return;
  }
  const compiled = vegaLite.compile(specification).spec;
  const view = new vega.View(vega.parse(compiled), {renderer: "none", logLevel: vega.Error});
  const svg = await view.toSVG();
  process.stdout.write(svg + "\n");
})();

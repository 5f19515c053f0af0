// Draws one figure as SVG without a browser: run by node after vega and vega-lite, with its `specification`. Writes the picture to
// standard output.
"use strict";
(async () => {
  // Without a browser, Vega guesses that all letters are wide.
  const narrow = /[iljtfrI.,:;'|()[\]{}! ]/g;
  vega.textMetrics.width = (item, text) => {
    const letters = String(text ?? item.text ?? "");
    const thin = (letters.match(narrow) ?? []).length;
    return (item.fontSize ?? 11) * (0.58 * (letters.length - thin) + 0.32 * thin);
  };
  const compiled = vegaLite.compile(specification).spec;
  const view = new vega.View(vega.parse(compiled), {renderer: "none", logLevel: vega.Error});
  const svg = await view.toSVG();
  process.stdout.write(svg + "\n");
})();

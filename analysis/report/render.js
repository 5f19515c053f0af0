// Draws one figure as SVG without a browser: run by node after vega and vega-lite, with `figure` = {specification, theme,
// colours, data}. Writes the picture to standard output.
"use strict";
(async () => {
  // Without a browser, Vega guesses that all letters are wide.
  const narrow = /[iljtfrI.,:;'|()[\]{}! ]/g;
  vega.textMetrics.width = (item, text) => {
    const letters = String(text ?? item.text ?? "");
    const thin = (letters.match(narrow) ?? []).length;
    return (item.fontSize ?? 11) * (0.58 * (letters.length - thin) + 0.32 * thin);
  };
  const coloured = value => JSON.parse(
    JSON.stringify(value).replace(/var\((--[a-z0-9-]+)\)/g, (whole, name) => figure.colours[name] ?? whole));
  const width = 560;
  const composed = figure.specification.vconcat !== undefined;
  const specification = JSON.parse(JSON.stringify(figure.specification, (key, value) =>
    key === "width" && value === "container" ? width - (composed ? 80 : 0) : value));
  specification.datasets = Object.fromEntries(figure.data.map(({name, columns, rows}) =>
    [name, rows.map(row => Object.fromEntries(columns.map(([field], i) => [field, row[i]])))]));
  if (!composed) specification.autosize = {type: "fit-x", contains: "padding"};
  const longest = Math.max(8, ...figure.data[0].rows.flatMap(row => figure.data[0].columns.map(
    ([field], i) => ["label", "series"].includes(field) ? String(row[i]).length : 0)));
  const legend = {...figure.theme.legend, columns: Math.min(8, Math.max(1, Math.floor(500 / (6.4 * longest + 32)))), labelLimit: 480};
  const compiled = vegaLite.compile(coloured(specification), {config: {...coloured({...figure.theme, legend}), background: "white"}}).spec;
  const view = new vega.View(vega.parse(compiled), {renderer: "none", logLevel: vega.Error});
  const svg = await view.toSVG();
  process.stdout.write(svg + "\n");
})();

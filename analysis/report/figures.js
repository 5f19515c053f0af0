// Completes the template of a figure, for a page and for a picture:
//
//   parameters: "$name" is the parameter of the figure with this name; without one, what would have this value is left out
//   panels:  usermeta.panels {field, titles, height} repeats the view, one below the other, for the rows with each value of the field
//   layers:  those of a dataset that is not there, or without a place in any row that they show, are left out
//   rows:    usermeta {row, rows} gives a view so many pixels for each name on its vertical axis, of which there are at least `rows`
//   titles:  a tooltip without one has that of its column; "@field" is the column's title with its unit, "words (@field)" only the
//            unit, and "@" that of the channel's own field
//   colours: each of the study's conditions has its own in all figures; a legend without a title that names one thing is left out
//   ticks:   an axis of numbers is labelled by labelTicks() below; axis.steps are the distances of ticks to choose from
//   domains: "proportions" is 0 to 1, or of proportions near 1 only these
//   width:   "container" becomes a number of pixels, and the legend has as many columns as fit
//
// The data stay in their units.
"use strict";
const completed = (() => {
  const figuresOfLabel = 4;
  const narrowest = 1 / 400; // range over its largest number that has two labels of four figures
  const prefixes = new Map([["f", -15], ["p", -12], ["n", -9], ["µ", -6], ["m", -3], ["", 0], ["k", 3], ["M", 6], ["G", 9], ["T", 12]]);
  const prefixOf = power => [...prefixes].find(([, own]) => own === power)[0];
  const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

  // A unit whose first symbol takes SI prefixes: the power of its own prefix, the symbol, and what follows it, " m/count".
  function prefixable(unit) {
    const parts = /^([fpnµmkMGT]?)(m|s|N|rad|Hz|V|A|W|J|g)($|[ /].*)/.exec(unit);
    return parts && {power: prefixes.get(parts[1]), symbol: parts[2], rest: parts[3]};
  }

  function withParameters(part, parameters) {
    if (Array.isArray(part)) return part.map(one => withParameters(one, parameters)).filter(one => one !== undefined);
    if (typeof part === "string" && /^\$\w+$/.test(part)) return parameters[part.slice(1)];
    if (part === null || typeof part !== "object") return part;
    const members = Object.entries(part).map(([key, one]) => [key, withParameters(one, parameters)]);
    return Object.fromEntries(members.filter(([, one]) => one !== undefined));
  }

  const titleOf = ([, title, unit]) => unit === "" || unit === "1" ? title : `${title} (${unit})`;

  // Titles by the columns of the data. Views and layers have the data of what they are in, unless they have their own.
  function entitle(part, figure, name) {
    if (part === null || typeof part !== "object") return;
    const own = part.data?.name ?? name;
    const columnOf = field => [...figure.data.filter(data => data.name === own), ...figure.data]
      .flatMap(data => data.columns).find(([known, title]) => known === field && title !== "") ?? [field, field, ""];
    for (const one of [part.encoding?.tooltip ?? []].flat()) one.title ??= titleOf(columnOf(one.field));
    if (part.title === "@") part.title += part.field;
    if (typeof part.title === "string")
      part.title = part.title.replace(/^@(\w+)$/, (_, field) => titleOf(columnOf(field)))
        .replace(/\(@(\w+)\)$/, (_, field) => `(${columnOf(field)[2]})`);
    for (const inner of Object.values(part)) entitle(inner, figure, own);
  }

  const distinct = (rows, field) => [...new Set(rows.map(row => row[field]))];

  // The rows that a view or a layer shows: those of its dataset, or of what it is in, that pass its filters {field, equal}.
  function rowsOf(part, outer, datasets) {
    const filters = (part.transform ?? []).map(one => one.filter).filter(filter => filter?.field);
    const rows = part.data ? part.data.values ?? datasets[part.data.name] ?? [] : outer;
    return rows.filter(row => filters.every(({field, equal}) => row[field] === equal));
  }

  function panelsOf(view, outer, datasets) {
    const {field, titles, height} = view.usermeta?.panels ?? {};
    const values = field ? distinct(rowsOf(view, outer, datasets), field) : [];
    if (values.length < 2) return [view];
    const only = (part, equal) => ({...part, transform: [{filter: {field, equal}}, ...part.transform ?? []]});
    const within = (layers, value) => layers?.map(layer => layer.layer ? {...layer, layer: within(layer.layer, value)} :
      layer.data && field in (rowsOf(layer, [], datasets)[0] ?? {}) ? only(layer, value) : layer);
    return values.map(value => ({...only(view, value), layer: within(view.layer, value), title: titles?.[value] ?? value,
                                 height: height ?? view.height}));
  }

  function inPanels(specification, datasets) {
    const {$schema, data, usermeta, vconcat, ...view} = specification;
    const views = (vconcat ?? [{...view, usermeta}]).flatMap(one => panelsOf(one, rowsOf({data}, [], datasets), datasets));
    if (vconcat) return {...specification, vconcat: views};
    return views.length > 1 ? {$schema, data, usermeta, vconcat: views} : specification;
  }

  function withoutEmptyLayers(part, outer, datasets) {
    if (!part.layer) return part;
    const rows = rowsOf(part, outer, datasets);
    const placed = layer => {
      const fields = ["x", "y"].map(name => layer.encoding?.[name]?.field).filter(Boolean);
      return layer.layer || rowsOf(layer, rows, datasets).some(row => fields.every(field => (row[field] ?? null) !== null));
    };
    return {...part, layer: part.layer.filter(placed).map(layer => withoutEmptyLayers(layer, rows, datasets))};
  }

  // The channels of names of colours in a view, with the names that it shows.
  function colouredNames(part, outer, datasets) {
    const rows = rowsOf(part, outer, datasets);
    const channel = part.encoding?.color;
    const own = channel?.type === "nominal" ? [{channel, names: distinct(rows, channel.field)}] : [];
    return [...own, ...(part.layer ?? []).flatMap(layer => colouredNames(layer, rows, datasets))];
  }

  function setColours(views, outer, datasets, conditions = []) {
    const coloured = views.flatMap(view => colouredNames(view, outer, datasets)).filter(({channel}) => !channel.scale?.domain);
    const all = [...new Set(coloured.flatMap(({names}) => names))];
    for (const {channel, names} of coloured) {
      const own = names.every(name => conditions.includes(name)) && names.length > 0;
      if (own || channel.scale?.range) channel.scale = {...channel.scale, domain: own ? conditions : all};
      if (channel.title === null && coloured.every(one => one.names.length < 2)) channel.legend = null;
    }
  }

  // An axis of numbers of a view: the channels that share it, and its range in the data or by the domain of its scale.
  function axisOf(view, name, right, outer, datasets) {
    const axis = {channels: [], low: Infinity, high: -Infinity, least: Infinity};
    const take = value => {
      if (typeof value !== "number") return;
      axis.low = Math.min(axis.low, value);
      axis.high = Math.max(axis.high, value);
      if (value !== 0) axis.least = Math.min(axis.least, Math.abs(value));
    };
    const visit = (part, outer) => {
      const rows = rowsOf(part, outer, datasets);
      const channel = part.encoding?.[name];
      if ((channel?.axis?.orient === "right") === right) {
        const isNumber = channel?.type === "quantitative";
        if (isNumber) axis.channels.push(channel);
        for (const {field} of [isNumber ? channel : null, part.encoding?.[`${name}2`]].filter(Boolean))
          for (const row of rows) take(row[field]);
      }
      for (const layer of part.layer ?? []) visit(layer, rows);
    };
    visit(view, outer);
    for (const {scale} of axis.channels) {
      if (scale?.type === "log") delete scale.zero;
      if (scale?.domain === "proportions") scale.domain = [axis.low >= 0.8 ? Math.floor(100 * axis.low - 0.5) / 100 : 0, 1];
    }
    axis.domain = axis.channels.map(one => one.scale?.domain).find(domain => domain?.length === 2 && typeof domain[0] === "number");
    if (axis.domain) [axis.low, axis.high] = [Infinity, -Infinity];
    axis.domain?.forEach(take);
    return axis;
  }

  // Ticks of an axis that is linear within `smallest` and logarithmic beyond. About zero there are few: at most three decades.
  function symlogTicks(low, high, smallest) {
    const largest = Math.max(Math.abs(low), Math.abs(high));
    const first = Math.ceil(Math.log10(low < 0 ? 4 * smallest : smallest) - 1e-9);
    const last = Math.floor(Math.log10(largest));
    const stride = low < 0 ? Math.max(1, Math.floor((last - first + 3) / 3)) : 1;
    const digits = low < 0 || largest > 300 * smallest ? [1] : [1, 2, 5];
    const ticks = [0];
    for (let power = last; power >= first - 1; power -= stride)
      for (const digit of digits) ticks.push(Number(`${digit}e${power}`), Number(`-${digit}e${power}`));
    return ticks.filter(tick => tick >= low && tick <= high && (tick === 0 || Math.abs(tick) > 0.999 * smallest));
  }

  // Multiples of the least step of which at most six fit into the range.
  function stepTicks(low, high, steps) {
    const step = steps.find(one => (high - low) / one <= 6) ?? steps.at(-1);
    const first = Math.ceil(low / step);
    return Array.from({length: Math.max(0, Math.floor(high / step) - first + 1)}, (_, i) => (first + i) * step);
  }

  // The power of ten by which numbers are divided so that four figures show them; null if they range over too many decades.
  // Without a prefix numbers of up to four digits are not divided.
  function powerFor(least, largest, logarithmic, hasPrefixes) {
    const thousands = value => 3 * Math.floor(Math.log10(value) / 3 + 1e-9);
    if (!hasPrefixes && largest < 1e4 && largest >= 0.01 && (!logarithmic || least >= 1e-3)) return 0;
    if (!logarithmic) return thousands(largest);
    let power = thousands(Math.sqrt(least) * Math.sqrt(largest));
    if (largest * 10 ** -power >= 1e4) power = thousands(largest);
    return least * 10 ** -power < 1e-3 * (1 - 1e-9) ? null : power;
  }

  // Labels of ticks whose values are divided by 10^power, where four figures state them exactly.
  function labelExpression(power, suffix = "") {
    const value = power === 0 ? "datum.value" : `datum.value * 1e${-power}`;
    const formatted = (text, figures) => `format(${text}, '.${figures}~r')`;
    return `${formatted(`abs(${value})`, figuresOfLabel)} === ${formatted(`abs(${value})`, 2 * figuresOfLabel)} ? ` +
           `${formatted(value, figuresOfLabel)} + '${suffix}' : ''`;
  }

  // Widens a range in which fewer than two numbers of four figures may lie.
  function widen(axis, channel, largest) {
    const span = axis.high - axis.low;
    if (axis.domain || span >= narrowest * largest || (span === 0 && channel.scale?.zero !== false)) return;
    const middle = (axis.low + axis.high) / 2;
    const half = narrowest * largest / 2;
    channel.scale = {...channel.scale, domain: [middle - half, middle + half]};
  }

  // Labels of an axis differ and have at most four figures:
  //   linear: the title gets the SI prefix of the largest number, "time (ms)"; proportions get "%"
  //   logarithmic, over less than about six decades: likewise, by the middle of the range
  //   logarithmic, over more: each label has its own prefix, "10 nm"
  //   the ticks that four figures state exactly are labelled; of a decade or more those at 1, 2 and 5
  // A linear range without two such labels is widened. Units without SI prefixes get a power of ten, "error (10³ counts)".
  function labelTicks(axis) {
    const channel = axis.channels.find(one => one.title);
    const largest = Math.max(Math.abs(axis.low), Math.abs(axis.high));
    if (!channel || axis.low > axis.high || largest === 0) return;
    const setting = (part, name) => axis.channels.map(one => one[part]?.[name]).find(value => value !== undefined);
    const type = setting("scale", "type") ?? "linear";
    const constant = setting("scale", "constant");
    const percent = setting("axis", "format")?.endsWith("p");
    const steps = setting("axis", "steps");
    const values = setting("axis", "values") ??
      (steps ? stepTicks(axis.low, axis.high, steps) : type === "symlog" ? symlogTicks(axis.low, axis.high, constant) : undefined);
    for (const one of axis.channels) for (const name of ["format", "steps"]) delete one.axis?.[name];
    const style = channel.axis = {...channel.axis};
    if (values) Object.assign(style, {values, tickCount: values.length}); // fewer would leave out every other one
    if (type === "linear") widen(axis, channel, largest);
    if (percent) {
      style.labelExpr = labelExpression(-2, " %");
      return;
    }
    const [, text, name] = /^(.*) \(((?:[^()]|\([^()]*\))*)\)$/.exec(channel.title) ?? [null, channel.title, ""];
    const unit = prefixable(name);
    const own = 10 ** (unit?.power ?? 0);
    const least = type === "symlog" ? Math.min(constant, largest) : axis.least;
    let power = powerFor(own * least, own * largest, type !== "linear", unit);
    if (power === null) {
      const symbol = unit && unit.rest === "" && unit.power === 0 ? unit.symbol : "";
      const label = `format(datum.value, '.${figuresOfLabel}~s')`;
      style.labelExpr = symbol ? `replace(${label}, regexp('([a-zA-Zµ]?)$'), ' $1${symbol}')` : label;
      if (symbol) channel.title = text;
      return;
    }
    if (unit) power = clamp(power, -15, unit.symbol === "s" ? 0 : 12); // thousands of seconds are not kiloseconds
    const digits = [...String(power)].map(digit => digit === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[digit]).join("");
    const scaled = unit ? prefixOf(power) + unit.symbol + unit.rest : [power === 0 ? "" : `10${digits}`, name].filter(Boolean).join(" ");
    channel.title = scaled ? `${text} (${scaled})` : text;
    style.labelExpr = labelExpression(power - (unit?.power ?? 0));
    if (type === "log" && !values && axis.high >= 2.5 * axis.low)
      style.labelExpr = `indexof('${axis.high >= 10 * axis.low ? "125" : "123457"}', ` +
                        `substring(format(datum.value, 'e'), 0, 1)) < 0 ? '' : ${style.labelExpr}`;
  }

  // Views of a composed figure cannot follow their container by themselves, and their axes take room beside them.
  function setWidth(part, width) {
    if (part === null || typeof part !== "object") return;
    if (part.width === "container") part.width = width;
    for (const inner of Object.values(part)) setWidth(inner, width);
  }

  // As many legend entries side by side as the longest leaves room for.
  function legendFor({data: [data]}, width) {
    const names = ["label", "series"].map(name => data.columns.findIndex(([field]) => field === name)).filter(i => i >= 0);
    const longest = Math.max(8, ...data.rows.flatMap(row => names.map(i => String(row[i]).length)));
    return {columns: clamp(Math.floor((width - 60) / (6.4 * longest + 32)), 1, 8), labelLimit: width - 80};
  }

  // The whole specification of a figure {specification, data}. `colours` are put in the place of the variables of the page.
  return (figure, theme, width, colours = {}) => {
    const datasets = Object.fromEntries(figure.data.map(data =>
      [data.name, data.rows.map(row => Object.fromEntries(data.columns.map(([field], i) => [field, row[i]])))]));
    const clone = part => JSON.parse(JSON.stringify(part));
    let specification = withParameters(clone(figure.specification), figure.parameters ?? {});
    entitle(specification, figure);
    specification = inPanels(specification, datasets);
    const outer = specification.vconcat ? rowsOf(specification, [], datasets) : [];
    const wholeViews = (specification.vconcat ?? [specification]).map(view => withoutEmptyLayers(view, outer, datasets));
    const views = clone(wholeViews); // panels share their parts
    specification = specification.vconcat ? {...specification, vconcat: views} : views[0];
    setColours(views, outer, datasets, figure.parameters?.conditions);
    for (const view of views) {
      const {row, rows = 1} = view.usermeta ?? {};
      if (row) view.height = row * Math.max(rows, distinct(rowsOf(view, outer, datasets), view.encoding.y.field).length);
      for (const name of ["x", "y"]) for (const right of [false, true]) labelTicks(axisOf(view, name, right, outer, datasets));
    }
    setWidth(specification, specification.vconcat ? width - (specification.usermeta?.margin ?? 80) : width);
    if (!specification.vconcat) specification.autosize = {type: "fit-x", contains: "padding"};
    specification.config = {...theme, legend: {...theme.legend, ...legendFor(figure, width)}};
    const text = JSON.stringify(specification).replace(/var\((--[\w-]+)\)/g, (all, name) => colours[name] ?? all);
    return {...JSON.parse(text), datasets};
  };
})();

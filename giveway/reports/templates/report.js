"use strict";
// Sorting and choosing rows; without this script every row stands in the order of the study.
(() => {
  const number = (text) => {
    const value = parseFloat(text.replaceAll("−", "-").replaceAll(",", "").replace(/^[<>]\s*/, ""));
    return Number.isNaN(value) ? null : value;
  };
  const compare = (a, b, column) => {
    const [left, right] = [a, b].map((row) => row.cells[column].textContent.trim());
    const [x, y] = [left, right].map(number);
    if (x !== null && y !== null) return x - y;
    return left.localeCompare(right, "en", { numeric: true });
  };
  const missing = (row, column) => ["N.A.", "–", ""].includes(row.cells[column].textContent.trim());

  for (const table of document.querySelectorAll("table.sortable")) {
    const body = table.tBodies[0];
    [...table.tHead.rows[0].cells].forEach((heading, column) => {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = heading.textContent;
      heading.replaceChildren(button);
      button.addEventListener("click", () => {
        const down = heading.getAttribute("aria-sort") === "ascending";
        for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
        heading.setAttribute("aria-sort", down ? "descending" : "ascending");
        const rows = [...body.rows];
        rows.sort((a, b) => {
          const gaps = missing(a, column) - missing(b, column);  // these stay at the end
          return gaps || (down ? -1 : 1) * compare(a, b, column);
        });
        body.append(...rows);
      });
    });
  }

  for (const table of document.querySelectorAll("table[data-filters]")) {
    const rows = [...table.tBodies[0].rows];
    const bar = document.createElement("div");
    bar.className = "filters";
    const count = document.createElement("output");
    const chosen = new Map();
    const update = () => {
      let shown = 0;
      for (const row of rows) {
        const kept = [...chosen].every(([k, select]) =>
          !select.value || row.cells[k].textContent.trim() === select.value);
        row.hidden = !kept;
        shown += kept;
      }
      count.textContent = `${shown} of ${rows.length} rows`;
    };
    for (const column of table.dataset.filters.split(",").map(Number)) {
      const values = [...new Set(rows.map((row) => row.cells[column].textContent.trim()))];
      if (values.length < 2) continue;
      const label = document.createElement("label");
      const select = document.createElement("select");
      label.append(table.tHead.rows[0].cells[column].textContent.trim(), select);
      select.append(new Option("all", ""), ...values.map((value) => new Option(value, value)));
      select.addEventListener("change", update);
      chosen.set(column, select);
      bar.append(label);
    }
    bar.append(count);
    table.closest(".scroll").before(bar);
    update();
  }
})();

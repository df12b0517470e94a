// Filters and sorts the table of a data set's page. Without a script, the table is sorted by
// verdict, worst first.
// SPDX-License-Identifier: Apache-2.0
"use strict";
(() => {
  const form = document.querySelector(".filters"), body = document.querySelector(".takes tbody");
  const heads = [...document.querySelectorAll(".takes th")];
  const place = (key) => heads.findIndex((head) => head.dataset.key === key);
  const order = { bad: 0, usable: 1, good: 2 };
  const textOf = (row, key) => row.cells[place(key)].firstChild?.textContent ?? "";

  /// Returns a number, the rank of a verdict or a text; null if there is no value.
  function valueOf(row, key) {
    const text = textOf(row, key);
    if (key === "verdict") return order[text];
    if (heads[place(key)].className === "text") return text;
    return text === "–" ? null : Number(text.replaceAll(",", ""));
  }

  const rows = [...body.rows].map((row) => ({
    row,
    words: row.textContent.toLowerCase(),
    verdict: textOf(row, "verdict"),
    subject: textOf(row, "subject"),
    class: row.dataset.class ?? "",
    streams: textOf(row, "streams").split(", "),
  }));

  function offer(name, values) {
    for (const value of [...new Set(values)].filter((one) => one !== "").sort()) {
      form.elements[name].add(new Option(value, value));
    }
  }

  function show() {
    const wanted = (name) => form.elements[name].value;
    const words = wanted("words").toLowerCase().split(/\s+/).filter((word) => word !== "");
    let count = 0;
    for (const one of rows) {
      const fits = words.every((word) => one.words.includes(word)) &&
        ["verdict", "subject", "class"].every((name) => wanted(name) === "" || one[name] === wanted(name)) &&
        (wanted("streams") === "" || one.streams.includes(wanted("streams")));
      one.row.hidden = !fits;
      count += fits ? 1 : 0;
    }
    form.elements.count.value = `${count.toLocaleString("en")} of ${rows.length.toLocaleString("en")}`;
    document.querySelector(".none").hidden = count > 0;
  }

  /// Sorts by a column. Rows without a value are always last. `key` "": the original order, worst
  /// first.
  function sort(key, descending) {
    const sign = descending ? -1 : 1;
    const sorted = rows.map((one) => ({ one, value: key === "" ? null : valueOf(one.row, key) }));
    if (key !== "") {
      sorted.sort((a, b) => {
        if (a.value === null || b.value === null) return (a.value === null) - (b.value === null);
        return sign * (typeof a.value === "string" ? a.value.localeCompare(b.value) : a.value - b.value);
      });
    }
    body.append(...sorted.map(({ one }) => one.row));
    for (const head of heads) {
      head.removeAttribute("aria-sort");
      if (key !== "" && head.dataset.key === key) head.setAttribute("aria-sort", descending ? "descending" : "ascending");
    }
  }

  offer("verdict", rows.map((one) => one.verdict));
  offer("subject", rows.map((one) => one.subject));
  offer("class", rows.map((one) => one.class));
  offer("streams", rows.flatMap((one) => one.streams));
  for (const head of heads.filter((one) => one.dataset.key !== undefined)) {
    const by = () => sort(head.dataset.key, head.getAttribute("aria-sort") === "ascending");
    head.tabIndex = 0;
    head.addEventListener("click", by);
    head.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      by();
    });
  }
  form.addEventListener("input", show);
  form.addEventListener("submit", (event) => event.preventDefault());
  form.addEventListener("reset", () => setTimeout(() => {
    sort("", false);
    show();
  }));
  form.hidden = false;
  show();
  document.body.dataset.ready = "true";
})();

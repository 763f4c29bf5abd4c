// Search in tables, a switch that shows some rows only, and what is unfolded on paper.
{
  const filters = new Map();
  const apply = (id) => {
    const { words = [], only = "" } = filters.get(id) || {};
    for (const row of document.querySelectorAll(`#${id} tbody tr`)) {
      const text = row.textContent.toLowerCase();
      row.hidden = !words.every((w) => text.includes(w)) || (only !== "" && !row.classList.contains(only));
    }
  };
  const set = (id, change) => { filters.set(id, { ...filters.get(id), ...change }); apply(id); };
  for (const input of document.querySelectorAll("input[data-filters]")) {
    input.addEventListener("input", () => set(input.dataset.filters, { words: input.value.toLowerCase().split(/\s+/).filter(Boolean) }));
  }
  for (const box of document.querySelectorAll("input[data-hides]")) {
    box.addEventListener("change", () => set(box.dataset.hides, { only: box.checked ? box.dataset.class : "" }));
  }
  const folded = [];
  addEventListener("beforeprint", () => {
    for (const part of document.querySelectorAll("#laws details:not([open])")) { part.open = true; folded.push(part); }
  });
  addEventListener("afterprint", () => { for (const part of folded.splice(0)) part.open = false; });
}

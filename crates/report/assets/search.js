// Search in tables, and a switch that shows some rows only.
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
}

// The theme's arrows beside its list of pages say nothing to who does not see them.
document.addEventListener("DOMContentLoaded", () => {
  for (const arrow of document.querySelectorAll("li > details > summary")) {
    const page = arrow.closest("li").querySelector("a");
    if (page) arrow.setAttribute("aria-label", `Pages of ${page.textContent.trim()}`);
  }
});

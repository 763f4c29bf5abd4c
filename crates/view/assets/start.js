// Figures and viewer, each whatever becomes of the other.
{
  const say = (id, error) => {
    const host = document.getElementById(id);
    if (host) host.append(FW.element("p", { class: "bad-text", role: "alert" }, `This part cannot be shown by this browser: ${error.message}`));
    console.error(error);
  };
  (async () => {
    if (FW.viewer && document.getElementById("viewer")) await FW.viewer().catch((e) => say("scene", e));
    await FW.figures().catch((e) => say("figures", e));
    document.documentElement.dataset.ready = "true";
  })();
}

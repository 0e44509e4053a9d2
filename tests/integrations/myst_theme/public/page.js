// Shows widgets as MyST's themes do: in a shadow root, with a model without a Python side.

for (const { esm, model } of JSON.parse(document.querySelector("script").textContent)) {
  const events = new EventTarget();
  const host = document.body.appendChild(document.createElement("div"));
  const el = document.createElement("div");
  host.attachShadow({ mode: "open" }).append(el);
  const { default: widget } = await import(`/build${esm}`);
  const shown = {
    get: (name) => model[name],
    set: (name, value) => {
      model[name] = value;
      events.dispatchEvent(new Event(`change:${name}`));
    },
    on: (name, call) => events.addEventListener(name, call),
  };
  await widget.initialize?.({ model: shown });
  await widget.render({ model: shown, el });
}

// What the page does by itself: the keyboard, full screen, the clipboard, the path over the picture,
// and the browser's own client. trame loads this as a plain script, and installs `flowtex_page` as a
// Vue plugin.
(() => {
  "use strict";

  /**
   * @typedef {{ name: string, dtype: string, shape: number[], bytes: number, digest: string, data: Uint8Array }} Part
   * @typedef {{ client: string, header: any, surface: string, steps: string[] }} Source
   * @typedef {{ x: number, y: number, weight: number, grey: string }} Sample
   * @typedef {[number, number][]} Line
   * @typedef {{ path: Line[], sampled: Line[], samples: Sample[], point: [number, number] | null, panes: number, aspect: number }} Over
   * @typedef {(event: string, ...values: unknown[]) => void} Emit
   */

  /** trame's own Vue, which is there once a component is. @returns {any} */
  const vue = () => /** @type {any} */ (window).Vue;

  // --- the keyboard ------------------------------------------------------------------------------

  /** Keys, and the command that each one sends to the server. @type {Record<string, string>} */
  const COMMANDS = {
    ArrowLeft: "left", ArrowRight: "right", ArrowUp: "up", ArrowDown: "down",
    "+": "closer", "=": "closer", "-": "farther", 0: "whole", d: "detail", ".": "next", ",": "previous",
  };
  /** Keys that only change the page. @type {Record<string, string>} */
  const TOGGLES = { " ": "play", t: "theme", Escape: "close", "?": "help" };
  const OWNERS = "input, textarea, select, [contenteditable], [role=slider], .v-overlay--active";

  function fullscreen() {
    if (document.fullscreenElement) return document.exitFullscreen();
    return document.documentElement.requestFullscreen();
  }

  /** @param {KeyboardEvent} event @param {Emit} emit */
  function press(event, emit) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const { target, key } = event;
    const escape = key === "Escape";
    // Some keys belong to what the person is typing in or moving.
    if (!escape && target instanceof Element && target.closest(OWNERS)) return;
    if (key === " " && target instanceof HTMLButtonElement) return;
    if (key === "f") void fullscreen();
    else if (key in COMMANDS) emit("command", COMMANDS[key]);
    else if (key in TOGGLES) emit("toggle", TOGGLES[key]);
    else return;
    if (!escape) event.preventDefault();
  }

  const keys = {
    name: "flowtex-keys",
    emits: ["command", "toggle", "linked"],
    /** @param {object} _ @param {{ emit: Emit }} context */
    setup(_, { emit }) {
      const heard = (/** @type {KeyboardEvent} */ event) => press(event, emit);
      vue().onMounted(() => {
        window.addEventListener("keydown", heard);
        // A link to a state holds it behind the #, of which browsers tell no server.
        if (window.location.hash.length > 1) emit("linked", window.location.hash);
      });
      vue().onBeforeUnmount(() => window.removeEventListener("keydown", heard));
      return () => null;
    },
  };

  // --- the path through a point ------------------------------------------------------------------

  /**
   * Draw a path in one of the panes: its whole length, and the part that is summed.
   * @param {Over} over @param {number} number of the pane @param {number} width of a pane @param {number} height
   */
  function drawn(over, number, width, height) {
    const { h } = vue();
    const at = (/** @type {[number, number]} */ [x, y]) => [(number + (x + 1) / 2) * width, ((1 - y) / 2) * height];
    const lines = (/** @type {Line[]} */ all, /** @type {string} */ kind) =>
      all.map((line) => {
        const points = line.map((place) => at(place).map((v) => v.toFixed(1))).join(" ");
        return h("polyline", { class: kind, points });
      });
    const parts = [...lines(over.path, "whole"), ...lines(over.sampled, "under"), ...lines(over.sampled, "sampled")];
    if (over.point) {
      const [cx, cy] = at(over.point);
      parts.push(h("circle", { cx, cy, r: 7, class: "point" }));
    }
    const id = `flowtex-pane-${number}`;
    const clip = h("clipPath", { id }, h("rect", { x: number * width, y: 0, width, height }));
    return h("g", { "clip-path": `url(#${id})` }, [clip, ...parts]);
  }

  const path = {
    name: "flowtex-path",
    props: ["over"],
    /** @param {{ over: Over | null }} props */
    setup(props) {
      const { h, ref, onMounted, onBeforeUnmount } = vue();
      const place = ref(null);
      const size = ref([1, 1]);
      const watcher = new ResizeObserver(([{ contentRect }]) => {
        size.value = [contentRect.width, contentRect.height];
      });
      onMounted(() => watcher.observe(place.value));
      onBeforeUnmount(() => watcher.disconnect());
      return () => {
        const { over } = props;
        if (!over) return h("div", { ref: place });
        const [width, height] = size.value;
        const panes = Array.from({ length: over.panes }, (_, n) => drawn(over, n, width / over.panes, height));
        return h("div", { ref: place }, h("svg", panes));
      };
    },
  };

  /** Width and height of the enlarged path, and what is left free around it, in pixels. */
  const [WIDE, HIGH, AROUND] = [232, 112, 9];
  /** Radius of a sample's dot, at most. */
  const LARGEST = 4.5;

  /**
   * Draw the samples of a path, enlarged: in the picture they are a pixel apart.
   * @param {Over} over
   */
  function enlarged({ samples, sampled, point, aspect }) {
    const { h } = vue();
    const flat = (/** @type {[number, number]} */ [x, y]) => [x * aspect, -y];
    const places = samples.map(({ x, y }) => flat([x, y]));
    const [xs, ys] = [places.map(([x]) => x), places.map(([, y]) => y)];
    const [left, top] = [Math.min(...xs), Math.min(...ys)];
    const [width, height] = [Math.max(...xs) - left, Math.max(...ys) - top];
    const scale = Math.min((WIDE - 2 * AROUND) / (width || 1e-9), (HIGH - 2 * AROUND) / (height || 1e-9));
    const at = (/** @type {number[]} */ [x, y]) => [
      WIDE / 2 + (x - left - width / 2) * scale,
      HIGH / 2 + (y - top - height / 2) * scale,
    ];
    const points = (/** @type {Line} */ line) => line.map((p) => at(flat(p)).map((v) => v.toFixed(1)).join(",")).join(" ");
    const lines = sampled.map((line) => h("polyline", { class: "sampled", points: points(line) }));
    const centres = places.map(at);
    const dots = samples.map(({ weight, grey }, n) => {
      const [cx, cy] = centres[n];
      const [nx, ny] = centres[n > 0 ? n - 1 : 1] ?? [cx + LARGEST, cy + LARGEST];
      // Neighbours touch, and do not hide one another.
      const most = Math.min(Math.max(0.75 * Math.hypot(nx - cx, ny - cy), 1.5), LARGEST);
      return h("circle", { cx, cy, r: most * (0.35 + 0.65 * weight), fill: grey });
    });
    if (point) {
      const [cx, cy] = at(flat(point));
      dots.push(h("circle", { cx, cy, r: 6, class: "point" }));
    }
    return h("svg", { viewBox: `0 0 ${WIDE} ${HIGH}`, width: WIDE, height: HIGH }, [...lines, ...dots]);
  }

  const inset = {
    name: "flowtex-inset",
    props: ["over"],
    /** @param {{ over: Over | null }} props */
    setup(props) {
      return () => vue().h("div", props.over?.samples.length ? [enlarged(props.over)] : []);
    },
  };

  // --- the browser's own client ------------------------------------------------------------------

  /**
   * Read one of the server's binary files of arrays; flowtex/app/browser.py says what is in it.
   * @param {string} address @returns {Promise<Part[]>}
   */
  async function fetched(address) {
    const answer = await fetch(address);
    if (!answer.ok) throw new Error(`${address}: ${answer.status}`);
    const bytes = await answer.arrayBuffer();
    const length = new DataView(bytes).getUint32(0, true);
    const header = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
    let at = 4 + length;
    return header.map((/** @type {Omit<Part, "data">} */ part) => {
      const data = new Uint8Array(bytes, at, part.bytes);
      at += part.bytes;
      return { ...part, data };
    });
  }

  /** Milliseconds between two messages to the server. */
  const WAIT = 100;

  /** Tell the server the latest value, after a while. @param {(value: unknown) => void} tell */
  function slowly(tell) {
    /** @type {{ value: unknown } | null} */
    let next = null;
    return (/** @type {unknown} */ value) => {
      if (!next) {
        setTimeout(() => {
          const last = next;
          next = null;
          tell(last?.value);
        }, WAIT);
      }
      next = { value };
    };
  }

  const same = (/** @type {unknown} */ a, /** @type {unknown} */ b) => JSON.stringify(a) === JSON.stringify(b);

  const client = {
    name: "flowtex-client",
    props: ["source", "settings", "camera", "time", "playing"],
    emits: ["update:camera", "update:time", "update:playing", "setting", "sharp", "point", "hover"],
    /**
     * @param {{ source: Source, settings: object, camera: unknown, time: number, playing: boolean }} props
     * @param {{ emit: Emit }} context
     */
    setup(props, { emit }) {
      const { h, ref, watch, onMounted, onBeforeUnmount } = vue();
      const place = ref(null);
      /** @type {any} */
      let viewer = null;
      /** @type {any} */
      let decoded = null;
      /** @type {unknown} */
      let lastCamera = null;
      let lastTime = NaN;
      let gone = false;
      let started = 0;

      async function load(/** @type {string} */ address) {
        const parts = await fetched(address);
        if (gone) return;
        for (const { name, dtype, shape, digest, data } of parts) {
          viewer.setPart(name, decoded(dtype, data), shape, digest);
        }
      }

      async function show() {
        const { source } = props;
        started = performance.now();
        viewer.setHeader(source.header);
        await load(source.surface);
        if (props.playing) viewer.play();
      }

      function look() {
        if (viewer.root.dataset.sharp === "true") emit("sharp", performance.now() - started);
        else started = performance.now();
      }
      const watcher = new MutationObserver(look);

      const tellCamera = slowly((camera) => emit("update:camera", camera));
      const tellTime = slowly((time) => emit("update:time", time));

      async function begin() {
        const module = await import(new URL(props.source.client, document.baseURI).href);
        if (gone) return;
        decoded = module.decoded;
        viewer = new module.Viewer(place.value, {
          rebuild: true,
          controls: false,
          bare: true,
          onCamera: (/** @type {unknown} */ camera) => tellCamera((lastCamera = camera)),
          onTime: (/** @type {number} */ time) => tellTime((lastTime = time)),
          onPlaying: (/** @type {boolean} */ playing) => emit("update:playing", playing),
          onPoint: (/** @type {any} */ point) => point && emit("point", [...point.index]),
          onSetting: (/** @type {string} */ name, /** @type {unknown} */ value) => emit("setting", [name, value]),
          onNeed: (/** @type {number} */ step) => void load(props.source.steps[step]),
        });
        viewer.root.style.height = "100%";
        watcher.observe(viewer.root, { attributeFilter: ["data-sharp"] });
        await show();
      }

      onMounted(begin);
      onBeforeUnmount(() => {
        gone = true;
        watcher.disconnect();
        viewer?.dispose();
      });
      watch(() => props.source, () => viewer && void show());
      watch(() => props.settings, (/** @type {object} */ values) => viewer?.setSettings(values));
      watch(() => props.camera, (/** @type {unknown} */ camera) => {
        if (camera && !same(camera, lastCamera)) viewer?.setCamera(camera);
      });
      watch(() => props.time, (/** @type {number} */ time) => {
        if (time !== lastTime && !viewer?.playing) viewer?.setTime(time);
      });
      watch(() => props.playing, (/** @type {boolean} */ playing) => {
        if (playing) viewer?.play();
        else viewer?.pause();
      });
      const tellHover = slowly((at) => emit("hover", at));
      const onPointermove = (/** @type {PointerEvent} */ event) => {
        const box = /** @type {HTMLElement} */ (place.value).getBoundingClientRect();
        const x = (2 * (event.clientX - box.left)) / box.width - 1;
        const y = 1 - (2 * (event.clientY - box.top)) / box.height;
        tellHover(event.buttons ? null : [x, y]);
      };
      const onPointerleave = () => tellHover(null);
      return () => h("div", { ref: place, onPointermove, onPointerleave });
    },
  };

  /**
   * An address that opens a page with a state: that of the door, with the secret that it keeps.
   * @param {string} hash
   */
  function linked(hash) {
    const folder = new URL(".", document.baseURI);
    const secret = sessionStorage.getItem(`flowtex ${folder.pathname} secret`);
    if (secret) folder.search = new URLSearchParams({ secret }).toString();
    return folder.href + hash;
  }

  /** @type {any} */ (window).flowtex_page = {
    install(/** @type {any} */ app) {
      for (const component of [keys, path, inset, client]) app.component(component.name, component);
      Object.assign(app.config.globalProperties, {
        flowtex_fullscreen: fullscreen,
        flowtex_address: linked,
        /** @param {string} text */
        flowtex_copy: (text) => navigator.clipboard?.writeText(text),
      });
    },
  };
})();

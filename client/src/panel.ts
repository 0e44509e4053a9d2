// What is seen around the picture: the bar, the legend, the settings, the readout and messages.

import { Axes, hasTicks } from "./axes.ts";
import { ColourControls } from "./colourcontrols.ts";
import { Controls, hasStreaming } from "./controls.ts";
import { dom, icon, numberText, pictureOf, withUnit, type IconName } from "./dom.ts";
import { Focus } from "./focus.ts";
import { groundKinds } from "./ground.ts";
import { Help, helpButton } from "./help.ts";
import { HELP_KEY, toggleFullscreen } from "./keyboard.ts";
import { Legend } from "./legend.ts";
import type { Timer } from "./lifetime.ts";
import { dateText } from "./lonlat.ts";
import type { Point } from "./picking.ts";
import type { Player } from "./player.ts";
import { placeText } from "./pointcard.ts";
import { AXES, type AxesKind, type Header, type Settings, type StructureHeader } from "./protocol.ts";
import STYLE from "./styles.css";
import type { Viewer } from "./viewer.ts";

/** Milliseconds for which a hint is shown; until lacking parts are named; in which a picture is saved. */
const HINT_MS = 1600;
const LATE_MS = 4000;
const SAVED_MS = 5000;
/** Height of a view below which nothing covers the flow and there are no axes, and below which there is no bar. */
const [SMALL_PX, TINY_PX] = [280, 160];
/** How many times faster than usual time may go by. */
const PACES = [0.25, 0.5, 1, 2, 4];
const KEY = /Mac|iP(hone|ad)/.test(navigator.platform) ? "⌘" : "Ctrl";
const HINT = `Click, or hold ${KEY}, to zoom with the wheel`;
const TIME_RANGE = { min: "0", max: "1", step: "any", "aria-label": "Time" };
/** What the name of a file cannot have. */
const FORBIDDEN = /[\\/:*?"<>|]+/g;

const styleSheet = new CSSStyleSheet();
styleSheet.replaceSync(STYLE);

export class Panel {
  private readonly viewer: Viewer;
  private readonly legend = new Legend();
  private readonly axes: Axes;
  private readonly axesMenu = dom("select", {}, AXES.map((kind) => dom("option", {}, [kind])));
  private readonly axesRow = dom("label", { class: "row" }, [
    dom("span", { class: "name" }, ["Axes"]),
    this.axesMenu,
  ]);
  private readonly paceMenu = dom(
    "select",
    {},
    PACES.map((pace) => dom("option", { value: `${pace}` }, [`${pace}×`])),
  );
  private readonly paceRow = dom("label", { class: "row", title: "Speed of the animation." }, [
    dom("span", { class: "name" }, ["Pace"]),
    this.paceMenu,
  ]);
  private readonly controls: Controls;
  private readonly colours: ColourControls;
  isShown: boolean;
  private axesKind: AxesKind | null = null;
  private isOpen = false;
  private legendLook = "";
  private readonly title = dom("div", { class: "title" });
  private readonly readout = dom("div", { class: "readout", role: "status" });
  /** Sliders of a formula's parameters. */
  private readonly parameters = dom("div", { class: "parameters" });
  private readonly head = dom("div", { class: "head glass", hidden: "" }, [this.title, this.parameters, this.readout]);
  private readonly note = dom("div", { class: "note", hidden: "", role: "alert" });
  /**
   * What is in progress, whose start is read out by screen readers, and its progress, which would be read repeatedly.
   */
  private readonly doing = dom("span", { role: "status" });
  private readonly count = dom("span", { "aria-hidden": "true" });
  private readonly busy = dom("div", { class: "busy", hidden: "" }, [this.doing, this.count]);
  private readonly told = dom("div", { class: "told glass", hidden: "", role: "status" });
  private readonly words = new Set<string>();
  private readonly hintBox = dom("div", { class: "hint glass", hidden: "" }, [HINT]);
  private readonly bar: HTMLElement;
  private readonly handle: HTMLElement;
  private readonly playButton: HTMLButtonElement;
  private readonly stepButtons: HTMLButtonElement[];
  private readonly toggles: Record<"lod" | "show_level", HTMLButtonElement>;
  private readonly gear: HTMLButtonElement;
  private readonly slider = dom("input", { type: "range", ...TIME_RANGE });
  private readonly timeText = dom("span", { class: "time" });
  private readonly track = dom("div", { class: "track" }, [this.slider, this.timeText]);
  private hintTimer: Timer | null = null;
  private lateTimer: Timer | null = null;
  private isFinding = false;
  private readonly help = new Help(() => this.showHelp(false));
  private readonly helpRow: HTMLElement;
  private readonly focus: Focus;

  constructor(viewer: Viewer) {
    this.viewer = viewer;
    const { root, stage, canvas, options } = viewer;
    this.isShown = options.controls ?? true;
    this.axes = new Axes(viewer);
    viewer.lifetime.listen(this.axesMenu, "change", () => {
      const kind = this.axesMenu.value as AxesKind;
      for (const { panel } of viewer.together) panel.chooseAxes(kind);
      options.onAxes?.(kind);
    });
    this.controls = new Controls(viewer);
    this.colours = new ColourControls(viewer);
    this.handle = this.button("show", "Show the bar (h)", () => this.toggle());
    this.handle.classList.add("handle", "glass");
    this.playButton = this.button("play", "Play (space)", () => viewer.togglePlaying());
    this.stepButtons = [
      this.button("previous", "Step back (,)", () => viewer.step(-1)),
      this.button("next", "Step forward (.)", () => viewer.step(1)),
    ];
    viewer.lifetime.listen(this.paceMenu, "change", () => (viewer.player.pace = Number(this.paceMenu.value)));
    viewer.lifetime.listen(this.slider, "input", () => viewer.scrub(Number(this.slider.value)));
    const toggle = (name: string) => () => viewer.choose(name, !viewer.settings[name]);
    this.toggles = {
      lod: this.button("lod", "Level of detail", toggle("lod")),
      show_level: this.button("levels", "Show level", toggle("show_level")),
    };
    this.gear = this.button("settings", "Settings", () => this.fold(!this.isOpen));
    this.bar = this.makeBar();
    canvas.className = "picture";
    root.classList.toggle("flowtex-bare", options.bare ?? false);
    const shadow = root.attachShadow({ mode: "open" });
    shadow.adoptedStyleSheets = [styleSheet];
    const { legend, controls, head, bar, handle, busy, hintBox, told, note } = this;
    const { card } = viewer;
    stage.className = "stage";
    stage.append(canvas, card.overlay, this.axes.element, card.element, busy, hintBox, told);
    shadow.append(dom("div", { class: "top" }, [head, legend.kinds, legend.element]), stage, bar, handle);
    shadow.append(controls.element, this.help.element, note);
    this.helpRow = dom("div", { class: "row" }, [helpButton(root, HELP_KEY)]);
    this.focus = new Focus(shadow, viewer.lifetime, (lost) => this.afterFocus(lost));
    viewer.lifetime.listen(told, "click", () => (told.hidden = true));
    this.arrange();
  }

  private button(name: IconName, title: string, press: () => void): HTMLButtonElement {
    const attributes = { type: "button", title, "aria-label": title, "data-name": name };
    const button = dom("button", attributes, [icon(name)]);
    this.viewer.lifetime.listen(button, "click", press);
    return button;
  }

  private makeBar(): HTMLElement {
    const { viewer } = this;
    return dom("div", { class: "bar glass", role: "toolbar", "aria-label": "Controls" }, [
      this.stepButtons[0],
      this.playButton,
      this.stepButtons[1],
      this.track,
      this.button("home", "Show everything (0)", () => viewer.reset()),
      this.toggles.lod,
      this.toggles.show_level,
      this.gear,
      this.button("save", "Save the picture", () => void this.save()),
      this.button("full", "Fill the screen (f)", () => this.fullscreen()),
      this.button("hide", "Hide the bar (h)", () => this.toggle()),
    ]);
  }

  build(): void {
    const { header } = this.viewer;
    if (!header) return;
    this.note.hidden = true;
    const isOther = this.controls.build(header);
    if (isOther) this.controls.element.prepend(...this.colours.rows, this.axesRow, this.paceRow);
    if (isOther) this.controls.element.append(this.helpRow);
    if (isOther) this.parameters.replaceChildren(...this.controls.parameters);
    this.showLegend();
    this.update();
    this.arrange();
  }

  update(): void {
    const { header, settings } = this.viewer;
    const { playing, varies } = this.viewer.player;
    this.name();
    this.controls.update();
    const isMarked = this.viewer.options.streamed && Number(settings.critical_points) > 0;
    if (this.viewer.options.streamed) this.showKinds((isMarked && header?.structure?.kinds) || []);
    if (this.legendLook !== this.lookOf(settings)) this.showLegend();
    for (const [name, button] of Object.entries(this.toggles)) {
      button.setAttribute("aria-pressed", String(Boolean(settings[name])));
    }
    const title = playing ? "Pause (space)" : "Play (space)";
    this.playButton.replaceChildren(icon(playing ? "pause" : "play"));
    this.playButton.title = title;
    this.playButton.setAttribute("aria-label", title);
    const streams = header !== null && hasStreaming(header);
    // The bar keeps its width when playing begins, and the button its place.
    this.playButton.hidden = this.track.hidden = this.paceRow.hidden = !varies && !streams;
    for (const button of this.stepButtons) button.hidden = !varies;
    this.paceMenu.value = String(this.viewer.player.pace);
    this.slider.disabled = !varies && settings.motion === "off";
    const width = (header && this.date(header)?.length) || 8 + withUnit("", header?.slices.timeUnit ?? "").length;
    this.timeText.style.minWidth = `${varies ? width : 7}ch`;
    this.tick();
  }

  /** Name the flow, or what is different in one of two views of it. */
  private name(): void {
    const { header, settings, root, options } = this.viewer;
    const names = (header?.differs ?? []).filter((name) => name in settings);
    const differences = names.map((name) => {
      const label = header?.table.find((row) => row.name === name)?.label ?? name;
      const value = settings[name];
      return `${label}: ${typeof value === "boolean" ? (value ? "on" : "off") : value}`;
    });
    const name = header?.name ?? "";
    const title = differences.join(", ") || (options.named && this.viewer.together.length < 2 ? "" : name);
    // The bar shows the time of the first view; a second view at another time shows it in its title.
    const { first } = this;
    const isApart = first !== this.viewer.player && this.viewer.player.time !== first.time;
    const moment = header && isApart && this.viewer.player.varies ? this.moment(header) : "";
    this.title.textContent = [title, moment].filter(Boolean).join(" · ");
    this.title.hidden = !this.title.textContent;
    this.title.classList.toggle("formula", /[=(]/.test(title));
    const label = options.label ?? (title || name);
    root.setAttribute("aria-label", label ? `Flow texture: ${label}` : "Flow texture");
  }

  /** The player of the first view. */
  private get first(): Player {
    return this.viewer.together[0]?.player ?? this.viewer.player;
  }

  tick(): void {
    const { header, player, settings } = this.viewer;
    if (!header || this.track.hidden) return;
    if (this.first !== player) this.name();
    const { first, last, now } = player.range(settings);
    this.slider.value = String((now - first) / (last - first || 1));
    const text = player.varies ? this.moment(header) : `${now.toFixed(1)} s`;
    if (this.timeText.textContent !== text) this.timeText.textContent = text;
  }

  /** The time shown, as text. */
  private moment(header: Header): string {
    const { player } = this.viewer;
    return this.date(header) ?? withUnit(numberText(player.time), header.slices.timeUnit);
  }

  /** The date that is shown, where times are dates. */
  private date({ slices }: Header): string | null {
    return dateText(slices.dates, slices.times, this.viewer.player.time);
  }

  /** The settings that the legend shows. */
  private lookOf({ show_level, strength, contrast }: Settings): string {
    return `${show_level} ${strength} ${contrast}`;
  }

  showLegend(): void {
    const { header, settings, parts } = this.viewer;
    this.legendLook = this.lookOf(settings);
    this.colours.update();
    if (header) this.legend.show(header, settings, parts.get("cmap")?.data);
  }

  /** Show which kinds of critical points are marked. */
  showKinds(kinds: StructureHeader["kinds"]): void {
    const { header } = this.viewer;
    const ground = header ? groundKinds(header) : [];
    this.legend.showKinds([...kinds, ...ground]);
  }

  /** Show the point under the pointer, or its longitude and latitude if it has no data. */
  read(point: Point | null, ground: readonly number[] | null = null): void {
    const { header } = this.viewer;
    this.readout.replaceChildren();
    this.legend.point(null);
    const position = point?.position ?? ground;
    if (!position || !header) return;
    const { parts, camera } = this.viewer;
    this.readout.append(dom("span", {}, [placeText(position, header, parts, camera)]));
    if (!point) return;
    if (point.mark) this.readout.append(dom("b", {}, [point.mark]));
    const { name, label, unit } = header.scalars;
    const value = point.values[name ?? ""];
    if (value === undefined) return;
    this.readout.append(dom("b", {}, [withUnit(`${label} ${numberText(value)}`, unit)]));
    this.legend.point(header, value);
  }

  /** Fold or unfold the settings. */
  fold(open = false): void {
    this.isOpen = open;
    this.arrange();
  }

  toggle(shown = !this.isShown): void {
    if (shown === this.isShown) return;
    this.isShown = shown;
    for (const { panel } of this.viewer.together) panel.arrange();
    this.viewer.options.onControls?.(shown);
  }

  private get isFramed(): boolean {
    const { header, options } = this.viewer;
    const isShown = options.follows?.panel.isShown ?? this.isShown;
    return isShown && !options.bare && header !== null;
  }

  /** Choose what stands at the borders of the picture. */
  chooseAxes(kind: AxesKind | null): void {
    this.axesKind = kind;
    this.arrange();
  }

  /** Draw the axes where the camera and the size of the picture put them. */
  showAxes(): void {
    const { header } = this.viewer;
    const usual = header && hasTicks(header) ? "ticks" : "none";
    const kind = this.axesKind ?? header?.axes ?? usual;
    const { clientHeight } = this.viewer.root;
    const shown = this.isFramed && clientHeight >= SMALL_PX ? kind : "none";
    this.axesMenu.value = kind;
    this.viewer.root.dataset.axes = shown;
    this.axes.draw(shown);
  }

  /** Show and hide what the state of the view asks for. */
  arrange(): void {
    const { header, options, root } = this.viewer;
    const isReady = header !== null;
    const follows = Boolean(options.follows);
    // The bar of a view that follows another takes its room alone, so that both pictures are alike.
    const isTiny = root.clientHeight < TINY_PX;
    this.bar.hidden = isTiny || !(this.isShown || (follows && this.isFramed)) || !isReady;
    this.bar.style.visibility = follows ? "hidden" : "";
    this.handle.hidden = isTiny || this.isShown || !isReady || follows;
    this.head.hidden = !(this.isShown || follows) || !isReady;
    this.controls.element.hidden = !this.isShown || !this.isOpen || !isReady;
    root.classList.toggle("flowtex-open", !this.controls.element.hidden);
    root.classList.toggle("flowtex-framed", this.isFramed);
    root.classList.toggle("flowtex-small", root.clientHeight < SMALL_PX);
    root.classList.toggle("flowtex-tiny", isTiny);
    this.showAxes();
    this.gear.setAttribute("aria-pressed", String(this.isOpen));
    this.keepFocus();
  }

  /** Show what keys do, or no longer; by default the other of both. */
  showHelp(shown = this.help.element.hidden): void {
    if (shown === !this.help.element.hidden) return;
    this.help.show(shown);
    this.keepFocus();
  }

  /** Give the focus back, if what has it has been hidden. */
  keepFocus(): void {
    this.focus.keep();
  }

  /** What has the focus after an element that is hidden, where nothing else had it before. */
  private afterFocus(lost: HTMLElement): HTMLElement {
    const { root } = this.viewer;
    if (this.bar.hidden) return this.handle.hidden ? root : this.handle;
    return this.controls.element.contains(lost) ? this.gear : root;
  }

  /** Show that parts are arriving, paths are traced, tiles are missing or details are left out, if so. */
  wait(missing: string[], isMade: boolean, isCoarse = false, isFinding = false): void {
    const { viewer, busy } = this;
    const { pending = 0, wanted = 0 } = viewer.tiles ?? {};
    const details = isCoarse ? `Fewer details while ${viewer.player.playing ? "playing" : "moving"}` : "";
    let doing = "";
    if (missing.length) doing = "Loading data";
    else if (!isMade) doing = "Tracing paths";
    else if (pending) doing = "Loading tiles";
    else if (isFinding) doing = "Finding critical points";
    this.isFinding = isFinding;
    const isOfTiles = doing === "Loading tiles";
    const count = isOfTiles ? `: ${wanted - pending} of ${wanted}` : doing ? " …" : details;
    if (this.doing.textContent !== doing) this.doing.textContent = doing;
    if (this.count.textContent !== count) this.count.textContent = count;
    busy.hidden = !(doing || count);
    const { source, isComing } = viewer.options;
    if (!missing.length || source?.hasSteps || isComing?.() || this.lateTimer) return;
    // Parts come in any order.
    this.lateTimer = viewer.lifetime.later(() => {
      this.lateTimer = null;
      const names = viewer.lacking.join(", ");
      if (names) this.fail("The scene is not complete.", `Missing: ${names}`);
    }, LATE_MS);
  }

  /** Show for a moment how the wheel zooms, or no longer. */
  hint(shown: boolean): void {
    const { lifetime } = this.viewer;
    lifetime.cancel(this.hintTimer);
    this.hintTimer = shown ? lifetime.later(() => this.hint(false), HINT_MS) : null;
    this.hintBox.hidden = !shown;
  }

  /** Say something once, beside the picture; a click takes it away. */
  tell(text: string): void {
    if (this.words.has(text)) return;
    this.words.add(text);
    this.told.textContent = text;
    this.told.hidden = false;
  }

  /** Take a message away, as a picture is complete. */
  clear(): void {
    this.wait([], true, false, this.isFinding);
    this.note.hidden = true;
    delete this.viewer.root.dataset.failed;
  }

  fail(problem: string, detail: string): void {
    this.note.replaceChildren(dom("strong", {}, [problem]), dom("pre", {}, [detail]));
    this.note.hidden = false;
    this.busy.hidden = true;
    this.viewer.root.dataset.failed = "true";
    this.viewer.options.onError?.(problem, detail);
  }

  fullscreen(): void {
    const { root, together } = this.viewer;
    toggleFullscreen((together.length > 1 && root.parentElement) || root);
  }

  private async save(): Promise<void> {
    const { viewer } = this;
    const href = URL.createObjectURL(await pictureOf(viewer.together));
    const name = (viewer.header?.name || "flow").replace(FORBIDDEN, " ").trim();
    dom("a", { href, download: `${name}.png` }).click();
    viewer.lifetime.later(() => URL.revokeObjectURL(href), SAVED_MS);
  }
}

// Files of the person's own: dropped on the page, or chosen, and sent to the server.

import { vue, type Emit } from "./vue.ts";

interface Props {
  address: string;
  /** Endings of files that are taken, as an input has them. */
  accept: string;
}

async function send(file: File, address: string): Promise<string> {
  const query = new URLSearchParams({ name: file.name });
  try {
    const answer = await fetch(`${address}?${query.toString()}`, { method: "POST", body: file });
    return answer.ok ? "" : await answer.text();
  } catch {
    return `${file.name}: could not be sent`;
  }
}

export const upload = {
  name: "flowtex-upload",
  props: ["address", "accept"],
  emits: ["problem", "busy"],
  setup(props: Props, { emit }: { emit: Emit }) {
    const { h, ref, onMounted, onBeforeUnmount } = vue();
    const isOver = ref(false);
    const input = ref<HTMLInputElement | null>(null);
    const ended = new AbortController();
    const take = async (files: FileList | null | undefined) => {
      for (const file of files ?? []) {
        emit("busy", `Sending ${file.name}`);
        const problem = await send(file, props.address);
        emit("busy", "");
        if (problem) emit("problem", problem);
      }
    };
    const hasFiles = ({ dataTransfer }: DragEvent) => dataTransfer?.types.includes("Files") ?? false;
    const over = (event: DragEvent) => {
      if (!hasFiles(event)) return;
      event.preventDefault();
      isOver.value = true;
    };
    const leave = (event: DragEvent) => {
      if (!event.relatedTarget) isOver.value = false;
    };
    const drop = (event: DragEvent) => {
      isOver.value = false;
      if (!hasFiles(event)) return;
      event.preventDefault();
      void take(event.dataTransfer?.files);
    };
    onMounted(() => {
      const options = { signal: ended.signal };
      window.addEventListener("dragover", over, options);
      window.addEventListener("dragleave", leave, options);
      window.addEventListener("drop", drop, options);
    });
    onBeforeUnmount(() => ended.abort());
    const change = () => {
      void take(input.value?.files).then(() => input.value && (input.value.value = ""));
    };
    const choose = { ref: input, type: "file", accept: props.accept, onChange: change, hidden: true };
    return () =>
      h("div", { class: "flowtex-upload" }, [
        h("input", { ...choose, "aria-label": "Open file" }),
        h("button", { class: "flowtex-link", onClick: () => input.value?.click() }, "Open file…"),
        h("div", { class: "flowtex-drop", hidden: !isOver.value }, `Drop it here: ${props.accept}`),
      ]);
  },
};

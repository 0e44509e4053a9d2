// trame's own Vue, which is there once a component is.

export type Emit = (event: string, ...values: unknown[]) => void;
export type Node = object;

interface Vue {
  h(kind: string, ...content: unknown[]): Node;
  ref<T>(value: T): { value: T };
  watch<T>(source: () => T, call: (value: T) => void): void;
  onMounted(call: () => void): void;
  onBeforeUnmount(call: () => void): void;
}

export const vue = (): Vue => (window as unknown as { Vue: Vue }).Vue;

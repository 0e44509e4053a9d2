// trame's own Vue, which is there once a component is, and its connection to the server.

export type Emit = (event: string, ...values: unknown[]) => void;
export type Node = object;

interface Vue {
  h(kind: string, ...content: unknown[]): Node;
  ref<T>(value: T): { value: T };
  onMounted(call: () => void): void;
  onBeforeUnmount(call: () => void): void;
}

/** wslink's session. */
interface Session {
  call(method: string, args: unknown[]): Promise<unknown>;
  subscribe(topic: string, call: (args: unknown[]) => void): unknown;
  unsubscribe(subscription: unknown): unknown;
}

interface Trame {
  trigger(name: string, args: unknown[]): Promise<unknown>;
  client: { getConnection(): { getSession(): Session } };
}

const page = () => window as unknown as { Vue: Vue; trame: Trame };

export const vue = (): Vue => page().Vue;
export const trame = (): Trame => page().trame;

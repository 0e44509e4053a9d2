// The script of the page that trame serves, built into flowtex/app/ui/static/flowtex.js. trame loads it
// as a plain script, and installs `flowtex_page` as a Vue plugin.

import { browser } from "./browser.ts";
import { hints } from "./hints.ts";
import { keys } from "./keys.ts";
import { upload } from "./upload.ts";

interface VueApp {
  component(name: string, component: object): void;
  config: { globalProperties: Record<string, unknown> };
}

/** An address that opens a page with a state: that of the door, with the secret that it keeps. */
function linked(hash: string): string {
  const folder = new URL(".", document.baseURI);
  const secret = sessionStorage.getItem(`flowtex ${folder.pathname} secret`);
  if (secret) folder.search = new URLSearchParams({ secret }).toString();
  return folder.href + hash;
}

Object.assign(window, {
  flowtex_page: {
    install(app: VueApp) {
      for (const component of [browser, hints, keys, upload]) app.component(component.name, component);
      Object.assign(app.config.globalProperties, {
        flowtex_address: linked,
        flowtex_copy: (text: string) => navigator.clipboard?.writeText(text),
      });
    },
  },
});

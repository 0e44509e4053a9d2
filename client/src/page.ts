// The script of an exported page that holds all of its flow.

import { openPage } from "./openpage.ts";

void openPage();

import { defineConfig } from "vitest/config";
import { licences } from "./licences.ts";

// The server that `npm run dev` passes all but the page on to: `toolpost studio --no-open` prints its address.
const server = process.env.TOOLPOST_STUDIO ?? "http://127.0.0.1:8000";
const passed = { target: server, changeOrigin: true, headers: { origin: server } };

export default defineConfig({
    base: "./",
    plugins: [licences],
    build: { target: "es2023", emptyOutDir: false, assetsInlineLimit: 0, modulePreload: { polyfill: false }, reportCompressedSize: false },
    server: { proxy: { "/socket": { ...passed, ws: true }, "/geometry": passed, "/moves": passed, "/upload": passed } },
    test: {
        benchmark: { include: ["tests/*.bench.ts"] },
        projects: [
            { test: { name: "parts", include: ["tests/*.test.ts"] } },
            // Browsers, on two cores: one file after the other.
            { test: { name: "page", include: ["tests/page/*.test.ts"], fileParallelism: false, testTimeout: 90_000, hookTimeout: 60_000, expect: { poll: { timeout: 20_000 } } } },
        ],
    },
});

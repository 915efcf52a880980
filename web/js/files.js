// The site's files, by their path: from the web server, or from the page itself where everything is
// in one file. Loads a few at a time, the most urgent first.
import {text} from "./strings.js";

const AT_ONCE = 4;
const RETRY_MS = [300, 1500, 6000]; // between the tries of a request that may succeed later

const SILENT_MS = 30000; // after which a connection counts as lost

const pause = ms => new Promise(done => setTimeout(done, ms));

// An answer and its bytes; neither, where the connection is reset or lost.
async function load(url)
{
    const stop = new AbortController(), parts = [];
    let timer = 0;
    const heard = () => {
        clearTimeout(timer);
        timer = setTimeout(() => stop.abort(), SILENT_MS);
    };
    try {
        heard();
        const answer = await fetch(url, {signal: stop.signal}), reader = answer.body.getReader();
        for (let part = {}; !part.done; parts.push(part.value || "")) {
            heard();
            part = await reader.read();
        }
        return {answer, data: await new Blob(parts).arrayBuffer()};
    } catch {
        return {};
    } finally {
        clearTimeout(timer);
    }
}

// files: of the manifest
export const bytesOf = files => files.reduce((sum, file) => sum + file.bytes, 0);

export class Files {
    // folder: that paths are relative to, as the page's own address has it; "" or ending with a slash
    constructor(onError, folder = "")
    {
        const embedded = document.getElementById("files");
        this.folder = folder;
        this.embedded = embedded && JSON.parse(embedded.textContent);
        this.onError = onError;
        this.bytes = 0;      // loaded so far
        this.waiting = [];   // {priority(), job()}
        this.running = 0;
    }

    // Of the web server. A token in the page's own address is passed on.
    url(path)
    {
        const url = new URL(this.folder + path, document.baseURI), token = new URLSearchParams(location.search).get("token");
        if (token)
            url.searchParams.set("token", token);
        return url;
    }

    // The file's bytes, at once.
    async get(path)
    {
        const data = await (this.embedded ? this.unpack(path) : this.fetch(path));
        this.bytes += data.byteLength;
        return data;
    }

    async unpack(path)
    {
        if (!(path in this.embedded))
            throw new Error(text.missing(path));
        return (await fetch(`data:;base64,${this.embedded[path]}`)).arrayBuffer();
    }

    // A connection may be reset or lost, and a server busy, for a moment.
    async fetch(path)
    {
        for (const wait of [...RETRY_MS, null]) {
            const {answer, data} = await load(this.url(path));
            if (answer && answer.ok)
                return data;
            if (wait === null || (answer && !answer.ok && answer.status < 500))
                throw new Error(text.notLoaded(path, answer ? answer.status : 0));
            await pause(wait);
        }
    }

    async json(path)
    {
        return JSON.parse(new TextDecoder().decode(await this.get(path)));
    }

    // An address that <img> takes.
    async address(path)
    {
        if (!this.embedded)
            return this.url(path).href;
        return URL.createObjectURL(new Blob([await this.get(path)]));
    }

    // Runs `job` once those with a smaller priority() are done.
    schedule(priority, job)
    {
        this.waiting.push({priority, job});
        this.next();
    }

    next()
    {
        while (this.running < AT_ONCE && this.waiting.length) {
            const urgency = this.waiting.map(task => task.priority());
            const least = urgency.indexOf(Math.min(...urgency));
            if (urgency[least] === Infinity)
                return; // nothing of what waits is wanted now
            const [task] = this.waiting.splice(least, 1);
            this.running++;
            task.job().catch(this.onError).finally(() => {
                this.running--;
                this.next();
            });
        }
    }
}

// The site's files, by their path: from the web server, or from the page itself where everything is
// in one file. Loads a few at a time, the most urgent first.
import {text} from "oriel/strings.js";

const AT_ONCE = 4, TRIES = 3;

function embeddedFiles()
{
    const element = document.getElementById("files");
    return element ? JSON.parse(element.textContent) : null;
}

function decodeBase64(string)
{
    const binary = atob(string), bytes = new Uint8Array(binary.length);
    for (let i = 0; i < binary.length; i++)
        bytes[i] = binary.charCodeAt(i);
    return bytes.buffer;
}

export class Files {
    // folder: that paths are relative to, as the page's own address has it; "" or ending with a slash
    constructor(onError, folder = "")
    {
        this.folder = folder;
        this.embedded = embeddedFiles();
        this.onError = onError;
        this.bytes = 0;      // loaded so far
        this.waiting = [];   // {priority(), run()}
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
        let data;
        if (this.embedded) {
            if (!(path in this.embedded))
                throw new Error(text.missing(path));
            data = decodeBase64(this.embedded[path]);
        } else {
            const answer = await fetch(this.url(path));
            if (!answer.ok)
                throw new Error(text.notLoaded(path, answer.status));
            data = await answer.arrayBuffer();
        }
        this.bytes += data.byteLength;
        return data;
    }

    async json(path)
    {
        return JSON.parse(new TextDecoder().decode(await this.get(path)));
    }

    async text(path)
    {
        return new TextDecoder().decode(await this.get(path));
    }

    // An address that <img> takes.
    async address(path)
    {
        if (!this.embedded)
            return this.url(path).href;
        return URL.createObjectURL(new Blob([await this.get(path)]));
    }

    // Runs `job` once those with a smaller priority() are done. What fails is tried again, later.
    schedule(priority, job)
    {
        this.waiting.push({priority, job, tries: 0});
        this.next();
    }

    get busy() { return this.running + this.waiting.length > 0; }

    next()
    {
        while (this.running < AT_ONCE && this.waiting.length) {
            const urgency = this.waiting.map(task => task.priority());
            const least = urgency.indexOf(Math.min(...urgency));
            if (urgency[least] === Infinity)
                return; // nothing of what waits is wanted now
            const [task] = this.waiting.splice(least, 1);
            this.running++;
            this.run(task).finally(() => {
                this.running--;
                this.next();
            });
        }
    }

    async run(task)
    {
        try {
            await task.job();
        } catch (error) {
            if (++task.tries < TRIES)
                this.waiting.push(task);
            else
                this.onError(error);
        }
    }
}

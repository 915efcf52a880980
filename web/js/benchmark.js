// Ten seconds past all photographs, and how long frames took.
import {viewAt} from "./keyframes.js";
import {clamp} from "./math.js";
import {photoView} from "./view.js";

const SECONDS = 10;

const ordered = values => [...values].sort((a, b) => a - b);
const share = (values, s) => ordered(values)[Math.min(Math.floor(s * values.length), values.length - 1)] || 0;

// walk: the page. A promise of the figures as JSON; the view is restored.
export async function benchmark(walk, seconds = SECONDS)
{
    const {navigator} = walk, {view, at} = navigator, keys = walk.photos.map(photoView), times = [];
    const loaded = walk.files.bytes;
    let began = 0, last = 0, passed = 0;
    walk.onFrame = () => {
        const now = performance.now();
        times.push(now - last);
        last = now;
    };
    while (passed < 1) {
        const now = await new Promise(requestAnimationFrame);
        began ||= now;
        last ||= now;
        passed = clamp((now - began) / (1000 * seconds), 0, 1);
        navigator.setView(keys.length > 1 ? viewAt(keys, passed) : keys[0]);
    }
    walk.onFrame = null;
    navigator.setView(view, at);
    return {
        title: walk.manifest.title, made_by: walk.manifest.made_by, browser: window.navigator.userAgent,
        drawn_by: walk.picture.remote ? "server" : "browser", window: [window.innerWidth, window.innerHeight],
        photographs: walk.photos.length, seconds, frames: times.length,
        frames_per_second: times.length / seconds,
        frame_ms: {median: share(times, 0.5), p95: share(times, 0.95), longest: Math.max(0, ...times),
                   first: times[0] || 0},
        bytes_loaded_before: loaded, bytes_loaded: walk.files.bytes, figures: walk.picture.figures(),
    };
}

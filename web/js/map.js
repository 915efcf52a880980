// The scene from above: points, the photographs' places and directions in the order they were
// taken, and the viewer.
import {across, add, cross, dot, normalize, rotateBack, scale} from "./math.js";
import {byId, make} from "./ui.js";
import {text} from "./strings.js";
import {forwardOf} from "./view.js";

const MARGIN = 0.06;       // of the map's side
const AROUND = 1.2;        // of the scene's distance: what of the points around photographs shows
const FRUSTUM = 0.05;      // of the map's side
const CLICK_REACH = 24;    // CSS pixels

export class Map2d {
    constructor(navigator, picture, goTo)
    {
        this.canvas = byId("map");
        this.canvas.ariaLabel = text.map;
        this.canvas.title = text.map;
        Object.assign(this, {navigator, picture, goTo});
        // The start looks upwards on the map.
        this.north = normalize(across(forwardOf(navigator.home), navigator.up));
        this.east = cross(this.north, navigator.up);
        this.points = null; // laid out when the map is first shown
        this.canvas.addEventListener("click", event => this.click(event));
    }

    flat(p) { return [dot(p, this.east), -dot(p, this.north)]; }

    frame()
    {
        const points = [];
        this.picture.forEachPoint((p, color) => points.push([...this.flat(p), dot(p, this.navigator.up), color]));
        const places = this.navigator.photos.map(p => this.flat(p.eye));
        const range = k => {
            const own = places.map(p => p[k]), reach = AROUND * this.navigator.distance;
            const low = Math.min(...own) - reach, high = Math.max(...own) + reach;
            const seen = points.map(p => p[k]).filter(v => v > low && v < high).concat(own);
            return [seen.reduce((a, b) => Math.min(a, b)), seen.reduce((a, b) => Math.max(a, b))];
        };
        const [x0, x1] = range(0), [y0, y1] = range(1);
        const side = Math.max(x1 - x0, y1 - y0, 1e-9) * (1 + 2 * MARGIN);
        Object.assign(this, {side, left: (x0 + x1 - side) / 2, top: (y0 + y1 - side) / 2});
        this.points = points.sort((a, b) => a[2] - b[2]); // higher ones last, on top
    }

    onMap([x, y], size) { return [(x - this.left) / this.side * size, (y - this.top) / this.side * size]; }
    place(p, size) { return this.onMap(this.flat(p), size); }

    drawBackground(size)
    {
        const canvas = make("canvas", {width: size, height: size});
        const context = canvas.getContext("2d"), image = context.createImageData(size, size);
        for (const [x, y, , color] of this.points) {
            const [px, py] = this.onMap([x, y], size).map(Math.floor);
            if (px >= 0 && py >= 0 && px < size && py < size)
                image.data.set([...color, 200], 4 * (py * size + px));
        }
        context.putImageData(image, 0, 0);
        this.background = canvas;
    }

    // A camera's place and the directions of its left and right border.
    drawCamera(context, view, size, length, color)
    {
        const half = view.frame ? view.frame.aspect / 2 / view.frame.fx : view.width / 2 / view.fx;
        const ends = [-half, half].map(x => {
            const ray = rotateBack(view.r, [x, 0, 1]);
            return this.place(add(view.eye, scale(ray, length * this.side)), size);
        });
        const [x, y] = this.place(view.eye, size);
        context.strokeStyle = context.fillStyle = color;
        context.beginPath();
        context.moveTo(...ends[0]);
        context.lineTo(x, y);
        context.lineTo(...ends[1]);
        context.closePath();
        context.stroke();
        context.beginPath();
        context.arc(x, y, size * 0.012, 0, 2 * Math.PI);
        context.fill();
    }

    draw()
    {
        const size = Math.round(this.canvas.clientWidth * window.devicePixelRatio);
        if (!size)
            return; // hidden
        if (!this.points)
            this.frame();
        if (this.canvas.width !== size || !this.background) {
            this.canvas.width = this.canvas.height = size;
            this.drawBackground(size);
        }
        const context = this.canvas.getContext("2d"), photos = this.navigator.photos;
        context.clearRect(0, 0, size, size);
        context.drawImage(this.background, 0, 0);
        context.lineWidth = size / 220;
        context.strokeStyle = "rgb(255 255 255 / 0.25)";
        context.beginPath();
        photos.forEach(p => context.lineTo(...this.place(p.eye, size)));
        context.stroke();
        photos.forEach(p => this.drawCamera(context, p, size, FRUSTUM, "rgb(190 200 220 / 0.8)"));
        this.drawCamera(context, this.navigator.view, size, 2.5 * FRUSTUM, "#e8b04a");
    }

    click(event)
    {
        const size = this.canvas.clientWidth, {left, top} = this.canvas.getBoundingClientRect();
        const apart = p => {
            const [x, y] = this.place(p.eye, size);
            return Math.hypot(x - (event.clientX - left), y - (event.clientY - top));
        };
        const nearest = this.navigator.photos.reduce((a, b) => apart(b) < apart(a) ? b : a);
        if (apart(nearest) < CLICK_REACH)
            this.goTo(nearest);
    }
}

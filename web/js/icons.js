// Paths of the tools' icons, in a box of 24.
export const icons = {
    home: "M4 11l8-7 8 7M6 10v10h12V10",
    previous: "M15 5l-7 7 7 7",
    next: "M9 5l7 7-7 7",
    snap: "M12 3v4M12 17v4M3 12h4M17 12h4M12 9a3 3 0 100 6 3 3 0 000-6",
    walk: "M13 4a1 1 0 100 .1M12 8l-2 6 3 2 1 5M10 14l-3 6M12 8l-4 2v3M12 8l3 4h3",
    fly: "M3 12l18-8-6 17-4-7z",
    orbit: "M20 12a8 8 0 11-3-6.2M17 2v4h-4",
    layer: "M12 3l9 5-9 5-9-5zM3 12l9 5 9-5M3 16l9 5 9-5",
    compare: "M12 3v18M4 6h5M4 18h5M4 6v12M15 6h5v12h-5",
    thumbs: "M3 6h18v12H3zM3 15l5-4 4 3 4-4 5 5",
    map: "M3 6l6-2 6 2 6-2v14l-6 2-6-2-6 2zM9 4v14M15 6v14",
    panel: "M5 7h9M18 7h1M5 12h2M11 12h8M5 17h9M18 17h1M16 5v4M9 10v4M16 15v4",
    screenshot: "M4 7h4l2-2h4l2 2h4v12H4zM12 10a3 3 0 100 6 3 3 0 000-6",
    full: "M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5",
    help: "M9 9a3 3 0 116 0c0 2-3 2-3 5M12 18v.1",
};

'use strict';
// Fills the tables of the page from the figures that lie in it as JSON.

function data(id) {
    return JSON.parse(document.getElementById(id).textContent);
}

function fixed(value, digits) {
    return typeof value === 'number' && isFinite(value) ? value.toFixed(digits) : '–';
}

function addRow(table, cells, header) {
    const row = table.insertRow();
    for (const text of cells) {
        const cell = document.createElement(header ? 'th' : 'td');
        cell.textContent = text;
        row.append(cell);
    }
    return row;
}

function figures(mean) {
    return [fixed(mean.psnr_db, 2) + ' dB', fixed(mean.ssim, 3),
            fixed(100 * mean.coverage, 1) + ' %', fixed(mean.render_ms, 0) + ' ms'];
}

function fillAccuracy(evals, main) {
    const table = document.getElementById('accuracy');
    addRow(table, ['method', 'PSNR', 'SSIM', 'covered', 'time a picture'], true);
    for (const one of evals)
        addRow(table, [one.method, ...figures(one.mean)])
            .classList.toggle('main', one.method === main);
}

const STAGE_NAMES = {
    collect: 'read photographs', calibrate: 'find where each was taken from',
    undistort: 'straighten photographs', densify: 'depth of each photograph',
    fuse: 'join depths to points', radii: 'size of points', expose: 'exposures',
};

function fillStages(stages, steps) {
    const table = document.getElementById('stages');
    const some = (value, digits, unit) => value > 0 ? fixed(value, digits) + unit : '';
    addRow(table, ['step', 'time', 'processor time', 'memory at most'], true);
    for (const step of steps) {
        if (step.name !== 'scene') {
            addRow(table, [step.name, fixed(step.seconds, 0) + ' s', '', '']);
            continue;
        }
        for (const [name, stage] of Object.entries(stages)) {
            const peak = Math.max(stage.peak_rss_mib || 0, stage.child_peak_rss_mib || 0);
            addRow(table, [`scene: ${STAGE_NAMES[name] || name}`, fixed(stage.wall_s, 1) + ' s',
                           some(stage.cpu_s, 1, ' s'), some(peak, 0, ' MiB')]);
        }
    }
}

// The figures of one photograph under its pictures, whose files leave the folders
// and mostly the extension of its name out.
function fillCaptions(evals) {
    for (const caption of document.querySelectorAll('[data-stem]')) {
        const { method, stem } = caption.dataset;
        const same = view => {
            const flat = view.photo.replace(/\//g, '_');
            return flat === stem || flat.replace(/\.[^.]*$/, '') === stem;
        };
        const one = evals.find(e => e.method === method);
        const view = one && one.views.find(same);
        if (view)
            caption.append(`, ${fixed(view.psnr_db, 1)} dB`);
    }
}

function slide(event) {
    const frame = event.target.parentElement;
    frame.querySelector('.top').style.clipPath = `inset(0 ${100 - event.target.value}% 0 0)`;
    frame.querySelector('.bar').style.left = `${event.target.value}%`;
}

const evals = [data('eval-json')].flat();
const scene = data('scene-json');
const run = data('run-json');
const best = evals.find(e => e.method === run.method);
const fact = (id, text) => { document.getElementById(id).textContent = text; };

fillAccuracy(evals, run.method);
fillStages(scene.stages || {}, run.steps);
fillCaptions(evals);
fact('fact-psnr', fixed(best.mean.psnr_db, 1) + ' dB');
fact('fact-ms', fixed(best.mean.render_ms, 0) + ' ms');
fact('fact-points', ((scene.counts && scene.counts.points) || 0).toLocaleString('en'));
const software = /llvmpipe|softpipe|swrast/i.test(best.device);
fact('device', best.device + (software ? ' (software: no graphics card was used)' : ''));
for (const input of document.querySelectorAll('.compare input'))
    input.addEventListener('input', slide);

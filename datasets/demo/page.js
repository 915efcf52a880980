'use strict';
// Fills the tables of the page from the figures that lie in it as JSON.

const data = id => JSON.parse(document.getElementById(id).textContent);
const fixed = (value, digits) => Number.isFinite(value) ? value.toFixed(digits) : '–';

function addRow(table, cells) {
    const row = document.getElementById(table).insertRow();
    for (const text of cells)
        row.insertCell().textContent = text;
    return row;
}

function figures(mean) {
    return [fixed(mean.psnr_db, 2) + ' dB', fixed(mean.ssim, 3),
            fixed(100 * mean.coverage, 1) + ' %', fixed(mean.render_ms, 0) + ' ms'];
}

function fillAccuracy(evals, main) {
    for (const one of evals)
        addRow('accuracy', [one.method, ...figures(one.mean)])
            .classList.toggle('main', one.method === main);
}

const STAGE_NAMES = {
    collect: 'read photographs', calibrate: 'find where each was taken from',
    undistort: 'straighten photographs', densify: 'depth of each photograph',
    fuse: 'join depths to points', radii: 'size of points', expose: 'exposures',
};

function fillStages(stages, steps) {
    const some = (value, digits, unit) => value > 0 ? fixed(value, digits) + unit : '';
    for (const step of steps) {
        if (step.name !== 'scene') {
            addRow('stages', [step.name, fixed(step.seconds, 0) + ' s', '', '']);
            continue;
        }
        for (const [name, stage] of Object.entries(stages)) {
            const peak = Math.max(stage.peak_rss_mib || 0, stage.child_peak_rss_mib || 0);
            addRow('stages', [`scene: ${STAGE_NAMES[name] || name}`, fixed(stage.wall_s, 1) + ' s',
                              some(stage.cpu_s, 1, ' s'), some(peak, 0, ' MiB')]);
        }
    }
}

// The figures of one photograph under its pictures, whose files leave the folders
// and mostly the extension of its name out.
function fillCaptions(evals) {
    for (const caption of document.querySelectorAll('[data-stem]')) {
        const { method, stem } = caption.dataset;
        const names = photo => [photo, photo.replace(/\.[^.]*$/, '')].map(name => name.replace(/\//g, '_'));
        const view = evals.find(e => e.method === method)?.views.find(v => names(v.photo).includes(stem));
        if (view)
            caption.append(`, ${fixed(view.psnr_db, 1)} dB`);
    }
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
fact('fact-points', (scene.counts?.points || 0).toLocaleString('en'));
const software = /llvmpipe|softpipe|swrast/i.test(best.device);
fact('device', best.device + (software ? ' (software: no graphics card was used)' : ''));
for (const input of document.querySelectorAll('.compare input'))
    input.addEventListener('input', () => input.parentElement.style.setProperty('--share', `${input.value}%`));

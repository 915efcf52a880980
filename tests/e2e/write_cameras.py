# Writes the true cameras of oriel synth (Inria's cameras.json: rotation is world_from_cam, columns x right,
# y down, z forward; position) as other programs do: write_cameras.py CAMERAS PHOTOGRAPHS OUT. Each format is
# written from its own documentation, and from nothing that reads it here.
import json, math, os, struct, sys
truth, images, out = sys.argv[1:4]
cams = json.load(open(truth))
def mul(a, b): return [[sum(a[i][k]*b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]
def T(a): return [list(r) for r in zip(*a)]
def apply(a, v): return [sum(a[i][k]*v[k] for k in range(3)) for i in range(3)]
def quat(r): # w x y z of a rotation, by the largest component
    t = r[0][0]+r[1][1]+r[2][2]
    c = [t, r[0][0], r[1][1], r[2][2]]
    m = c.index(max(c))
    if m == 0:
        s = 2*math.sqrt(1+t); return [s/4, (r[2][1]-r[1][2])/s, (r[0][2]-r[2][0])/s, (r[1][0]-r[0][1])/s]
    i = m-1; j = (i+1) % 3; k = (i+2) % 3
    s = 2*math.sqrt(1+r[i][i]-r[j][j]-r[k][k]); q = [0]*4
    q[0] = (r[k][j]-r[j][k])/s; q[1+i] = s/4; q[1+j] = (r[i][j]+r[j][i])/s; q[1+k] = (r[i][k]+r[k][i])/s
    return q
def gl(c): return [[c['rotation'][i][0], -c['rotation'][i][1], -c['rotation'][i][2]] for i in range(3)]
def folder(n, link='images'):
    d = f'{out}/{n}'; os.makedirs(d, exist_ok=True)
    os.makedirs(os.path.dirname(f'{d}/{link}') or d, exist_ok=True)
    if not os.path.lexists(f'{d}/{link}'): os.symlink(os.path.abspath(images), f'{d}/{link}')
    return d
name = lambda c: c['img_name']
W, H, F, FY = cams[0]['width'], cams[0]['height'], cams[0]['fx'], cams[0]['fy']
# Metashape: the transform is row-major, camera to chunk, OpenCV's axes; a chunk transform of scale 2 and a turn
s, tr = 2.0, [3., -4., 5.]; tu = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
d = folder('metashape'); x = ['<?xml version="1.0" encoding="UTF-8"?><document version="1.5.0"><chunk label="Chunk 1" enabled="true">',
 f'<sensors next_id="1"><sensor id="0" label="x" type="frame"><resolution width="{W}" height="{H}"/>',
 f'<calibration type="frame" class="initial"><resolution width="{W}" height="{H}"/><f>{F*1.1}</f></calibration>',
 f'<calibration type="frame" class="adjusted"><resolution width="{W}" height="{H}"/><f>{FY}</f><cx>0</cx><cy>0</cy></calibration></sensor></sensors>',
 '<components next_id="1" active_id="0"><component id="0" label="C"><transform><rotation locked="false">', ' '.join(str(v) for r in tu for v in r),
 '</rotation><translation>', ' '.join(map(str, tr)), f'</translation><scale>{s}</scale></transform></component></components><cameras next_id="9"><group id="0" label="g">']
for i, c in enumerate(cams):
    r = mul(T(tu), c['rotation']); p = apply(T(tu), [(a-b)/s for a, b in zip(c['position'], tr)])
    x.append(f'<camera id="{i}" sensor_id="0" component_id="0" label="{name(c)}"><transform>' + ' '.join(repr(v) for k in range(3) for v in r[k]+[p[k]]) + ' 0 0 0 1</transform></camera>')
x.append('<camera id="77" sensor_id="0" label="lost"/></group></cameras></chunk></document>')
open(d+'/cameras.xml', 'w').write('\n'.join(x))
# RealityScan: R(camera to world, OpenGL) = Rz(-heading) Rx(pitch) Ry(roll); f of 35 mm film, centre in widths
d = folder('realityscan')
with open(d+'/cameras.csv', 'w', newline='') as f:
    f.write('#cameras %d\r\n#name,x,y,alt,heading,pitch,roll,f,px,py,k1,k2,k3,k4,t1,t2\r\n' % len(cams))
    for c in cams:
        m = gl(c)
        pitch = math.asin(max(-1, min(1, m[2][1]))); roll = math.atan2(-m[2][0], m[2][2]); head = math.atan2(m[0][1], m[1][1])
        f.write(','.join([name(c)+'.jpg']+[repr(v) for v in (*c['position'], math.degrees(head), math.degrees(pitch), math.degrees(roll), F*36/max(W, H), 0., 0., 0., 0., 0., 0., 0., 0.)])+'\r\n')
# Meshroom 2023: numbers as strings, mm, principal point from the centre, rotation world to camera, column by column
d = folder('meshroom')
json.dump(dict(version=['1', '2', '6'], views=[dict(viewId=str(100+i), poseId=str(100+i), intrinsicId='1', path=f'/home/u/photos/{name(c)}.jpg', width=str(W), height=str(H)) for i, c in enumerate(cams)],
 intrinsics=[dict(intrinsicId='1', width=str(W), height=str(H), sensorWidth='36', sensorHeight='24', type='radial3', focalLength=repr(F*36/W), pixelRatio='1', principalPoint=['0', '0'], distortionParams=['0', '0', '0'])],
 poses=[dict(poseId=str(100+i), pose=dict(transform=dict(rotation=[repr(T(c['rotation'])[r][k]) for k in range(3) for r in range(3)], center=[repr(v) for v in c['position']]), locked='0')) for i, c in enumerate(cams)]), open(d+'/cameras.sfm', 'w'))
# OpenSfM: angle-axis, world to camera
d = folder('opensfm')
def axis(r):
    q = quat(r); n = math.sqrt(sum(v*v for v in q[1:])); a = 2*math.atan2(n, q[0])
    return [v/n*a if n else 0 for v in q[1:]]
json.dump([dict(cameras={'v2': dict(projection_type='brown', width=W, height=H, focal_x=F/max(W, H), focal_y=FY/max(W, H), c_x=0., c_y=0., k1=0., k2=0., p1=0., p2=0., k3=0.)},
 shots={name(c)+'.jpg': dict(rotation=axis(T(c['rotation'])), translation=[-v for v in apply(T(c['rotation']), c['position'])], camera='v2') for c in cams}, points={})], open(d+'/reconstruction.json', 'w'))
# Polycam: camera to world, OpenGL's axes
d = folder('polycam', 'keyframes/images'); os.makedirs(d+'/keyframes/cameras', exist_ok=True)
for c in cams:
    m = gl(c); j = dict(fx=F, fy=FY, cx=W/2, cy=H/2, width=W, height=H, blur_score=90.)
    for r in range(3):
        for k in range(4): j[f't_{r}{k}'] = m[r][k] if k < 3 else c['position'][r]
    json.dump(j, open(f'{d}/keyframes/cameras/{name(c)}.json', 'w'))
# Record3D: quaternion x y z w and place, camera to world, OpenGL's axes; K column by column; pictures are numbered
d = f'{out}/record3d'; os.makedirs(d+'/rgbd', exist_ok=True)
json.dump(dict(poses=[quat(gl(c))[1:]+quat(gl(c))[:1]+c['position'] for c in cams], K=[F, 0, 0, 0, FY, 0, W/2, H/2, 1], w=W, h=H, fps=30), open(d+'/metadata.json', 'w'))
for i, c in enumerate(cams):
    if not os.path.lexists(f'{d}/rgbd/{i}.jpg'): os.symlink(f'{os.path.abspath(images)}/{name(c)}.jpg', f'{d}/rgbd/{i}.jpg')
# LLFF: rows of [down right backwards place hwf], near, far
d = folder('llff'); body = b''
for c in sorted(cams, key=name):
    r = c['rotation']
    for i in range(3): body += struct.pack('<5d', r[i][1], r[i][0], -r[i][2], c['position'][i], [H, W, F][i])
    body += struct.pack('<2d', 1, 100)
head = "{'descr': '<f8', 'fortran_order': False, 'shape': (%d, 17), }" % len(cams); head += ' '*((64-(10+len(head)+1) % 64) % 64)+'\n'
open(d+'/poses_bounds.npy', 'wb').write(b'\x93NUMPY\x01\x00'+struct.pack('<H', len(head))+head.encode()+body)
# NVM: name, f, quaternion w x y z (world to camera), place, distortion, 0
d = folder('nvm')
with open(d+'/model.nvm', 'w') as f:
    f.write('NVM_V3 \n\n%d\n' % len(cams))
    for c in cams: f.write('images/%s.jpg\t%r %s %s 0 0\n' % (name(c), F, ' '.join(map(repr, quat(T(c['rotation'])))), ' '.join(map(repr, c['position']))))
    f.write('\n1\n0 0 1 255 128 0 2 0 5 10 10 1 6 11 11\n\n0\n')

# Writes a synthetic scene as published sets lay theirs out: write_layouts.py TRUTH PHOTOGRAPHS SMALL.
#     garden, bonsai    Mip-NeRF 360: sparse/0 of pictures 4 and 2 times as large, and smaller pictures
#     fern              LLFF: poses_bounds.npy of pictures 4 times as large, names of their own
# The full size of a side is no multiple, as those of the sets are not.
import json, os, shutil, struct, sys
truth, photos, small = sys.argv[1:4]

# COLMAP's model of pictures `factor` times as large, whose sides are less by `less` pixels; no points.
def write_model(folder, factor, less):
    os.makedirs(folder)
    rows = lambda name: [line.split() for line in open(f'{truth}/sparse/{name}')
                         if line.strip() and line[0] != '#']
    cameras, images = rows('cameras.txt'), rows('images.txt')
    with open(folder + '/cameras.bin', 'wb') as f:
        f.write(struct.pack('<Q', len(cameras)))
        for number, model, width, height, *parameters in cameras:
            assert model == 'PINHOLE'
            f.write(struct.pack('<IIQQ4d', int(number), 1, factor * int(width) - less,
                                factor * int(height) - less, *(factor * float(v) for v in parameters)))
    with open(folder + '/images.bin', 'wb') as f:
        f.write(struct.pack('<Q', len(images)))
        for number, *pose, camera, name in images:
            f.write(struct.pack('<I7dI', int(number), *map(float, pose), int(camera)))
            f.write(name.encode() + b'\0' + struct.pack('<Q', 0))
    with open(folder + '/points3D.bin', 'wb') as f:
        f.write(struct.pack('<Q', 0))

def copy(source, folder, name='%s'):
    os.makedirs(folder)
    for i, photo in enumerate(sorted(os.listdir(source))):
        shutil.copy(f'{source}/{photo}', folder + '/' + (photo if name == '%s' else name % i))

write_model('garden/sparse/0', 4, 2)
copy(small, 'garden/images_8')
copy(photos, 'garden/images_4')
copy(small, 'garden/images_2')
write_model('bonsai/sparse/0', 2, 1)
copy(photos, 'bonsai/images_2')
copy(small, 'bonsai/images_4')

# Rows of [down right backwards place hwf], near, far.
cameras = sorted(json.load(open(truth + '/cameras.json')), key=lambda c: c['img_name'])
body = b''
for c in cameras:
    r, hwf = c['rotation'], [4 * c['height'], 4 * c['width'], 4 * c['fx']]
    for i in range(3):
        body += struct.pack('<5d', r[i][1], r[i][0], -r[i][2], c['position'][i], hwf[i])
    body += struct.pack('<2d', 1, 100)
head = "{'descr': '<f8', 'fortran_order': False, 'shape': (%d, 17), }" % len(cameras)
head += ' ' * ((64 - (10 + len(head) + 1) % 64) % 64) + '\n'
copy(small, 'fern/images')
copy(photos, 'fern/images_4', 'image%03d.jpg')
with open('fern/poses_bounds.npy', 'wb') as f:
    f.write(b'\x93NUMPY\x01\x00' + struct.pack('<H', len(head)) + head.encode() + body)

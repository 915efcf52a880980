// Parameter blocks shared by C and GLSL, with std140 layout. Scalars are packed side by side as in
// C. Vectors of four start at multiples of 16 bytes, vectors of two at multiples of 8, as members of their order do in
// C, too. A block is a multiple of 16 bytes.
#ifndef ORL_INTEROP_H
#define ORL_INTEROP_H

#ifdef __STDC_VERSION__
#define ORL_BLOCK(name) struct name
#define FLOAT(name) float name
#define INT(name) int name
#define IVEC2(name) int name[2]
#define VEC4(name) _Alignas(16) float name[4]
#define VEC4S(name, count) _Alignas(16) float name[count][4]
#define IVEC4(name) int name[4]
#else
#define ORL_BLOCK(name) layout(std140, binding = 0) uniform name
#define FLOAT(name) float name
#define INT(name) int name
#define IVEC2(name) ivec2 name
#define VEC4(name) vec4 name
#define VEC4S(name, count) vec4 name[count]
#define IVEC4(name) ivec4 name
#endif

// Work group sizes.
#define ORL_POINT_GROUP 128
#define ORL_PIXEL_GROUP_X 16
#define ORL_PIXEL_GROUP_Y 8

#endif

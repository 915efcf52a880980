// The camera of a synthetic photograph. Matches struct frame_params in
// datasets/synth_frame.c.
layout(std140, binding = 0) uniform Params {
    vec4 right;   // world directions of the camera's axes (x right, y down, z forward)
    vec4 down;
    vec4 forward;
    vec4 eye;     // world, metres; y is up, the ground is y = 0
    vec4 camera;  // fx, fy, cx, cy in pixels
    ivec4 size;   // width, height, first row of this dispatch, end row
    uvec4 seed;   // x: seed of all noise
    vec4 view_light; // x: contrast, stops; y: gloss; z: radius of the bars; w: plain share
};

const float SKY_T = 1e9;

// Ray through a pixel position, with unit z in camera space, so that the ray parameter t is depth.
vec3 ray_through(vec2 pixel)
{
    vec2 c = (pixel - camera.zw) / camera.xy;
    return right.xyz * c.x + down.xyz * c.y + forward.xyz;
}

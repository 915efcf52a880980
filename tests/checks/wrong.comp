#version 450 core
// Some drivers take this; the language does not.
layout(local_size_x = 1) in;
layout(r32f, binding = 0) writeonly uniform image2D target;
void main()
{
    imageStore(target, ivec2(0), 1.0);
}
// source 0: wrong.comp

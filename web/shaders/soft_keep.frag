// What soft splats show in a photograph, into the alpha of one level of the photograph.
uniform sampler2D shown; // mipmapped
uniform int level;
layout(location = 0) out vec4 kept;

void main()
{
    kept = vec4(texelFetch(shown, ivec2(gl_FragCoord.xy), level).r);
}

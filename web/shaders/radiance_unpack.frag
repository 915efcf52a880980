// A photograph's radiance from its file, as src/walk/site_photos.c packs it.
uniform sampler2D packed_radiance;
uniform float peak, mu;
layout(location = 0) out vec4 radiance;

void main()
{
    vec3 code = texelFetch(packed_radiance, ivec2(gl_FragCoord.xy), 0).rgb;
    radiance = vec4((exp(code * log(1.0 + mu)) - 1.0) * (peak / mu), 1.0);
}

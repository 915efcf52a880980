// Princ 2014, equation 2.8: how well a photograph's direction agrees with the view's, times how
// directly it looks at the surface, times the area of the hull of the model in it.
// source.selected has the first and the last factor, and the photograph's direction.

const float LIMIT_COS = 0.34202014; // of 70 degrees, beyond which a surface is not painted

float weight_of(photo source, Point at)
{
    float facing = dot(-at.normal, source.selected.yzw);
    float weight = source.selected.x * ((1.0 + facing) / (1.0 - LIMIT_COS) + 1.0);
    return facing >= LIMIT_COS ? max(weight, 0.0) : 0.0;
}

// Of a photograph that looks straight at the surface, from the view's direction.
float weight_unit(bool guessed)
{
    return 2.0 / (1.0 - LIMIT_COS) + 1.0;
}

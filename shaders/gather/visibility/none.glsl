// Every photograph sees every point.

float visible_surface(photo source, Point at, vec4 seen, float z)
{
    return 1.0;
}

float visible_guess(photo source, Point at, vec4 seen, float z)
{
    return 1.0;
}

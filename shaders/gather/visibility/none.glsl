// Every photograph sees every point.

float visible_surface(photo shot, Point at, vec4 seen, float z)
{
    return 1.0;
}

float visible_guess(photo shot, Point at, vec4 seen, float z)
{
    return 1.0;
}

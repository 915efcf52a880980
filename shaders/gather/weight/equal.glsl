// Every photograph that sees the point has the same weight: Li 2003, equation 1.

float weight_of(photo source, Point at)
{
    return 1.0;
}

float weight_unit(bool guessed)
{
    return 1.0;
}

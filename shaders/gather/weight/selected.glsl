// The weight that the selection gives to the whole photograph: Orzan 2005, 4.3.2.

float weight_of(photo source, Point at)
{
    return source.selected.x;
}

float weight_unit(bool guessed)
{
    return 1.0;
}

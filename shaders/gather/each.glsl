// Every pixel asks each photograph of the dispatch.

int photo_first()
{
    return 0;
}

// -1: photograph i was the last.
int photo_next(int i)
{
    return i + 1 < photo_count ? i + 1 : -1;
}

# Writes OUTPUT, a C table of the files below FOLDER, for a program that needs no files beside it.
# HEADER declares the struct TYPE (name, text), of which the table TABLE is an array that a NULL
# name ends. Run as:
#   cmake -DFOLDER=... -DHEADER=... -DTYPE=... -DTABLE=... -DOUTPUT=... -P EmbedFiles.cmake
file(GLOB_RECURSE files RELATIVE "${FOLDER}" "${FOLDER}/*")
list(SORT files)
set(arrays "")
set(rows "")
set(index 0)
foreach(file IN LISTS files)
    file(READ "${FOLDER}/${file}" hex HEX)
    string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
    string(REGEX REPLACE "(................................................................................)"
           "\\1\n" bytes "${bytes}")
    # Unsigned in between: a byte above 127 does not fit a char.
    string(APPEND arrays "static const unsigned char text_${index}[] = {\n${bytes}0x00};\n")
    string(APPEND rows "    {\"${file}\", (const char *)text_${index}},\n")
    math(EXPR index "${index} + 1")
endforeach()
file(WRITE "${OUTPUT}" "// Made by EmbedFiles.cmake.
#include \"${HEADER}\"\n\n${arrays}
const struct ${TYPE} ${TABLE}[] = {\n${rows}    {NULL_NAME, NULL_NAME},\n};\n")
file(READ "${OUTPUT}" text)
string(REPLACE "NULL_NAME" "0" text "${text}")
file(WRITE "${OUTPUT}" "${text}")

# Writes OUTPUT, a C table of all shader files below SHADER_DIR (see
# src/gpu/shader_table.h). Run as: cmake -DSHADER_DIR=... -DOUTPUT=... -P this.
file(GLOB_RECURSE files RELATIVE "${SHADER_DIR}" "${SHADER_DIR}/*.comp" "${SHADER_DIR}/*.glsl"
     "${SHADER_DIR}/*.vert" "${SHADER_DIR}/*.frag" "${SHADER_DIR}/*.h")
list(SORT files)
set(arrays "")
set(rows "")
set(index 0)
foreach(file IN LISTS files)
    file(READ "${SHADER_DIR}/${file}" hex HEX)
    string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
    string(REGEX REPLACE "(................................................................................)"
           "\\1\n" bytes "${bytes}")
    string(APPEND arrays "static const char text_${index}[] = {\n${bytes}0x00};\n")
    string(APPEND rows "    {\"${file}\", text_${index}},\n")
    math(EXPR index "${index} + 1")
endforeach()
file(WRITE "${OUTPUT}" "// Made by EmbedShaders.cmake from shaders/.
#include \"gpu/shader_table.h\"\n\n${arrays}
const struct orl_shader_file orl_shader_table[] = {\n${rows}    {NULL_NAME, NULL_NAME},\n};\n")
file(READ "${OUTPUT}" text)
string(REPLACE "NULL_NAME" "0" text "${text}")
file(WRITE "${OUTPUT}" "${text}")

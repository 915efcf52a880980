# Writes OUTPUT, C source of `const char NAME[]` with the text of INPUT. Run as:
# cmake -DINPUT=.. -DNAME=.. -DHEADER=.. -DOUTPUT=.. -P this.
file(READ "${INPUT}" hex HEX)
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
string(REGEX REPLACE "(................................................................................)"
       "\\1\n" bytes "${bytes}")
file(WRITE "${OUTPUT}" "#include \"${HEADER}\"\n\nconst char ${NAME}[] = {\n${bytes}0x00};\n")

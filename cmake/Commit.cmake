# Writes OUTPUT, a header with the commit that SOURCE_DIR is at; of changed files their
# checksum too. Left alone when nothing changed. Run as: cmake -DSOURCE_DIR=.. -DOUTPUT=.. -P this.
set(commit "")
find_program(git git)
if(git)
    execute_process(COMMAND ${git} -C ${SOURCE_DIR} rev-parse --short=12 HEAD
                    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    execute_process(COMMAND ${git} -C ${SOURCE_DIR} diff HEAD -- src shaders cmake CMakeLists.txt
                    OUTPUT_VARIABLE changes ERROR_QUIET)
    if(commit AND changes)
        string(MD5 sum "${changes}")
        string(SUBSTRING ${sum} 0 8 sum)
        string(APPEND commit "+${sum}")
    endif()
endif()
file(WRITE ${OUTPUT}.new "#define ORL_COMMIT \"${commit}\"\n")
file(COPY_FILE ${OUTPUT}.new ${OUTPUT} ONLY_IF_DIFFERENT)

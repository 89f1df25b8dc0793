# Writes OUT: a C++ array IDENTIFIER with the bytes of IN.
file(READ ${IN} hex HEX)
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
file(WRITE ${OUT} "extern const unsigned char ${IDENTIFIER}[];\nextern const unsigned long ${IDENTIFIER}_size;\n"
     "const unsigned char ${IDENTIFIER}[] = {${bytes}0};\nconst unsigned long ${IDENTIFIER}_size = sizeof(${IDENTIFIER}) - 1;\n")

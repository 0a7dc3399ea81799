#!/usr/bin/env python3
"""Prints a C program that prints the size of every struct of superdeform.h and the offset of every field.

    layout.py HEADER > layout.c
"""

import re
import sys


def structs(header):
    """Name and field names of every struct."""
    text = re.sub(r"//[^\n]*", "", header)
    for match in re.finditer(r"typedef struct (\w+) \{(.*?)\} \1;", text, re.S):
        fields = [re.sub(r"\[.*?\]", "", line).split()[-1].lstrip("*") for line in match[2].split(";") if line.strip()]
        yield match[1], fields


def main():
    print('#include "superdeform.h"\n#include <stdio.h>\n\nint main(void) {')
    for name, fields in structs(open(sys.argv[1], encoding="utf-8").read()):
        print(f'  printf("{name} %zu\\n", sizeof({name}));')
        for field in fields:
            print(f'  printf("{name}.{field} %zu\\n", offsetof({name}, {field}));')
    print("  return 0;\n}")


main()

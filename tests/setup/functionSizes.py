"""Lists functions of more than 80 lines or 7 parameters; fails if there is one.

Usage: functionSizes.py FILE...    sources and headers in C or C++, whose functions
                                   begin and end with a brace in the first column
"""
import re
import sys

MAX_LINES = 80
MAX_PARAMETERS = 7

DECLARATION = re.compile(
    r'(\w+)\s*\(((?:[^()]|\([^()]*\))*)\)\s*(?:const\s*)?(?::[^;{}]*)?[;{]')
PARAMETER = re.compile(r'\w[\w:<>]*[\s*&]+(?:\(\*)?\w+[\])\[\w\s*+]*(?:=.*)?$', re.S)


def without_comments(text):
    """The text with comments and strings blanked, line breaks kept."""
    pattern = re.compile(r'/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"', re.S)
    return pattern.sub(lambda found: re.sub(r'[^\n]', ' ', found.group()), text)


def long_functions(text):
    """(line, lines) of the blocks in the first column that follow a parenthesis."""
    lines = text.split('\n')
    for begin, line in enumerate(lines):
        if line != '{' or not re.search(r'\)\s*(?:const)?$|^[\s:,]*\w+[({].*[)}],?$', lines[begin - 1]):
            continue
        end = next(n for n in range(begin, len(lines)) if lines[n].startswith('}'))
        if end - begin - 1 > MAX_LINES:
            yield begin, end - begin - 1


def split(arguments):
    """The arguments at the commas outside all brackets."""
    depth, parts = 0, ['']
    for letter in arguments:
        depth += (letter in '([{<') - (letter in ')]}>')
        if letter == ',' and depth == 0:
            parts.append('')
        else:
            parts[-1] += letter
    return [' '.join(part.split()) for part in parts]


def wide_functions(text):
    """(line, name, parameters) of declarations and definitions."""
    for found in DECLARATION.finditer(text):
        parts = split(found.group(2))
        if len(parts) > MAX_PARAMETERS and all(map(PARAMETER.match, parts)):
            yield text.count('\n', 0, found.start()) + 1, found.group(1), len(parts)


def main():
    found = 0
    for name in sys.argv[1:]:
        with open(name, encoding='utf-8') as file:
            text = without_comments(file.read())
        for line, count in long_functions(text):
            print(f'{name}:{line}: a function of {count} lines, more than {MAX_LINES}')
            found += 1
        for line, function, count in wide_functions(text):
            print(f'{name}:{line}: {function} has {count} parameters, more than {MAX_PARAMETERS}')
            found += 1
    return found > 0


if __name__ == '__main__':
    sys.exit(main())

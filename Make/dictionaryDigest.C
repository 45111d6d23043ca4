/*---------------------------------------------------------------------------*\
License
    GPL-3.0-or-later, see COPYING.

Description
    Foam::dictionary::digest() for an OpenFOAM whose own fails. Its stream of
    digests (OSHA1stream) takes text but no single characters, and libraries
    built by gcc 12 or newer write these singly: every function object then
    stops with 'error in IOstream "sha1"'. Newer versions of OpenFOAM take both.

    Here a string takes the text. Digests are compared within a run only.

\*---------------------------------------------------------------------------*/

#include "dictionary.H"
#include "OStringStream.H"
#include "SHA1.H"

Foam::SHA1Digest Foam::dictionary::digest() const
{
    OStringStream text;
    for (const entry& e : *this)
    {
        text << e;
    }
    return SHA1(text.str()).digest();
}

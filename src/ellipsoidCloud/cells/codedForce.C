// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Class
    Foam::codedForce

Description
    An external force that is written as C++ in the case: compiled by
    OpenFOAM's dynamic code, which does so only where allowSystemOperations is
    on, and not for an administrator.

    The code adds to force [N, lab] and torque [N m, lab], and knows of the cell
    t, x, R, semiAxes, E and gradE as externalForce::pose describes them.

Usage
    \table
        Property    | Description                        | Required | Default
        code        | statements                         | yes |
        unsteady    | does it depend on t?               | no  | no
        codeInclude | lines before the function          | no  | none
        localCode   | functions and constants            | no  | none
        codeOptions | EXE_INC of the compiler            | no  | none
        codeLibs    | LIB_LIBS of the linker             | no  | none
    \endtable
    such as
    \verbatim
    spring
    {
        type    coded;
        code    #{ force -= 1e-6*x; #};
    }
    \endverbatim

\*---------------------------------------------------------------------------*/

#include "addToRunTimeSelectionTable.H"
#include "checkedEntries.H"
#include "dynamicCode.H"
#include "dynamicCodeContext.H"
#include "externalForce.H"
#include "masterGate.H"
#include "OSspecific.H"
#include "Switch.H"

// * * * * * * * * * * * * * * * * Declarations * * * * * * * * * * * * * * * //

namespace Foam
{

class codedForce
:
    public externalForce
{
    // Private Data Types

        //- The function that is compiled; it needs no header of this library
        using function = void (*)
        (
            const scalar t,
            const vector& x,
            const tensor& R,
            const vector& semiAxes,
            const vector& E,
            const tensor& gradE,
            vector& force,
            vector& torque
        );


    // Private Data

        const bool unsteady_;

        function function_;


    // Private Member Functions

        //- What is compiled
        static string source
        (
            const word& name,
            const dynamicCodeContext& context
        )
        {
            return
                "#include \"tensor.H\"\n#include \"mathematicalConstants.H\"\n"
              + context.include()
              + "\nnamespace Foam\n{\nnamespace\n{\n" + context.localCode()
              + "\n}\nextern \"C\" void " + name
              + "\n(\n    const scalar t, const vector& x, const tensor& R,"
                " const vector& semiAxes,\n    const vector& E,"
                " const tensor& gradE, vector& force, vector& torque\n)\n{\n"
              + context.code() + "\n}\n}\n";
        }

        //- Compile, on the master, and load; collective
        static function loaded(const dictionary& dict)
        {
            const word name("force_" + dict.dictName());
            dynamicCodeContext context(dict);
            dynamicCode code(name, name);

            // Compiled anew also where another version writes it otherwise
            const string text(source(name, context));
            context.append(text);

            bool made = true;
            if (Pstream::master())
            {
                if (!code.upToDate(context))
                {
                    code.reset(context);
                    code.addCreateFile("force.C", text);
                    code.addCreateFile
                    (
                        "Make/files",
                        "force.C\n\nLIB = $(PWD)/../platforms/$(WM_OPTIONS)"
                        "/lib/lib" + name
                    );
                    code.addCreateFile
                    (
                        "Make/options",
                        "EXE_INC = " + context.options() + "\nLIB_LIBS = "
                      + context.libs()
                    );
                    code.copyOrCreateFiles(true);
                }
                made = code.wmakeLibso();
            }
            broadcast(made);

            const masterGate once;
            void* library = made ? dlOpen(code.libPath(), false) : nullptr;
            const bool found = library && dlSymFound(library, name);

            if (!found)
            {
                FatalIOErrorInFunction(streamOf(dict, "code"))
                    << (made ? "cannot load " : "cannot compile code into ")
                    << code.libRelPath().c_str()
                    << (made ? "" : ": the compiler's words are above")
                    << exit(FatalIOError);
            }

            return reinterpret_cast<function>(dlSym(library, name));
        }


public:

    //- Runtime type information
    TypeName("coded");


    // Constructors

        //- Construct from its dictionary; collective
        explicit codedForce(const dictionary& dict)
        :
            unsteady_(dict.getOrDefault<Switch>("unsteady", false))
        {
            {
                const masterGate once;

                checkKeywords
                (
                    dict,
                    {
                        "type", "code", "unsteady", "codeInclude", "localCode",
                        "codeOptions", "codeLibs"
                    }
                );
                dict.get<string>("code");
                dynamicCode::checkSecurity("coded", dict);
            }
            function_ = loaded(dict);
        }


    // Member Functions

        virtual bool unsteady() const
        {
            return unsteady_;
        }

        virtual void add(const pose& at, vector& force, vector& torque) const
        {
            function_
            (
                at.t, at.x, at.R, at.semiAxes, at.E, at.gradE, force, torque
            );
        }
};


// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

defineTypeNameAndDebug(codedForce, 0);
addToRunTimeSelectionTable(externalForce, codedForce, dictionary);

} // End namespace Foam
